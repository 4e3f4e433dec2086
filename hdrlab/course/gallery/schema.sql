-- The tables of a gallery, and what its database forbids: see store.py.
CREATE TABLE gallery (
  one INTEGER PRIMARY KEY CHECK (one = 1), title TEXT NOT NULL, closes TEXT NOT NULL,
  marks INTEGER NOT NULL CHECK (marks >= 0), secret BLOB NOT NULL,
  pairs INTEGER NOT NULL CHECK (pairs >= 0), CHECK ((marks = 0) <> (pairs = 0))) STRICT;
CREATE TABLE artifacts (
  id TEXT PRIMARY KEY, team TEXT NOT NULL, title TEXT NOT NULL, caption TEXT NOT NULL,
  width INTEGER NOT NULL, height INTEGER NOT NULL, hangs INTEGER NOT NULL DEFAULT 1) STRICT;
CREATE UNIQUE INDEX one_of_a_team ON artifacts (team) WHERE hangs;
CREATE TABLE changes (
  at TEXT NOT NULL, team TEXT NOT NULL, source TEXT NOT NULL, before TEXT NOT NULL, after TEXT NOT NULL,
  votes INTEGER NOT NULL) STRICT;
CREATE TABLE voters (
  id TEXT PRIMARY KEY, name TEXT NOT NULL, team TEXT NOT NULL,
  link TEXT UNIQUE, link_digest BLOB, session TEXT UNIQUE, session_digest BLOB) STRICT;
CREATE TABLE ballots (voter TEXT PRIMARY KEY REFERENCES voters, cast_at REAL NOT NULL) STRICT;
CREATE TABLE votes (
  voter TEXT NOT NULL REFERENCES ballots, artifact TEXT NOT NULL REFERENCES artifacts,
  PRIMARY KEY (voter, artifact)) STRICT, WITHOUT ROWID;
CREATE TRIGGER own BEFORE INSERT ON votes WHEN
  (SELECT team FROM artifacts WHERE id = NEW.artifact) = (SELECT team FROM voters WHERE id = NEW.voter)
  BEGIN SELECT RAISE(ABORT, 'own team'); END;
CREATE TRIGGER gone BEFORE INSERT ON votes WHEN (SELECT NOT hangs FROM artifacts WHERE id = NEW.artifact)
  BEGIN SELECT RAISE(ABORT, 'hangs no longer'); END;
CREATE TRIGGER many BEFORE INSERT ON votes WHEN
  (SELECT count(*) FROM votes WHERE voter = NEW.voter) >= (SELECT marks FROM gallery)
  BEGIN SELECT RAISE(ABORT, 'too many'); END;
CREATE TABLE comparisons (
  voter TEXT NOT NULL REFERENCES voters, first TEXT NOT NULL REFERENCES artifacts,
  second TEXT NOT NULL REFERENCES artifacts, winner TEXT NOT NULL, cast_at REAL NOT NULL,
  PRIMARY KEY (voter, first, second), CHECK (first < second), CHECK (winner IN (first, second))) STRICT, WITHOUT ROWID;
CREATE TRIGGER own_of_pair BEFORE INSERT ON comparisons WHEN
  (SELECT team FROM voters WHERE id = NEW.voter) IN
  (SELECT team FROM artifacts WHERE id IN (NEW.first, NEW.second))
  BEGIN SELECT RAISE(ABORT, 'own team'); END;
CREATE TRIGGER gone_of_pair BEFORE INSERT ON comparisons WHEN
  EXISTS (SELECT 1 FROM artifacts WHERE NOT hangs AND id IN (NEW.first, NEW.second))
  BEGIN SELECT RAISE(ABORT, 'hangs no longer'); END;
CREATE TRIGGER many_pairs BEFORE INSERT ON comparisons WHEN
  NOT EXISTS (SELECT 1 FROM comparisons
    WHERE voter = NEW.voter AND first = NEW.first AND second = NEW.second) AND
  (SELECT count(*) FROM comparisons JOIN artifacts a ON a.id = first JOIN artifacts b ON b.id = second
    WHERE voter = NEW.voter AND a.hangs AND b.hangs) >= (SELECT pairs FROM gallery)
  BEGIN SELECT RAISE(ABORT, 'too many'); END;
CREATE TABLE scores (
  artifact TEXT PRIMARY KEY REFERENCES artifacts, tmqi REAL NOT NULL, pu_ssim REAL NOT NULL) STRICT;
