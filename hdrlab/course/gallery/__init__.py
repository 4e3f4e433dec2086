"""The class votes on its artifacts: a small web application over one folder.

store, ballots       the database: what hangs, who marked what; places, and columns for the gradebook
pairs                instead of ballots: which of two is better, asked pair by pair
bradley_terry        strengths of artifacts from the answers about pairs, with intervals
agreement            how often the class agrees with TMQI and PU-SSIM
tokens               who may: personal links and sessions
collect, pictures    what students hand in, decoded and encoded again
web                  the pages, what stands before them, and the one who writes

What somebody may try, what stops it, and the promise in tests/course/test_gallery_attacks.py that it does:

=====================  ==========================================================  ======================
attack                 what stops it                                               test_...
=====================  ==========================================================  ======================
forged link            256 random bits, compared in constant time                  a_forged_link
guessed links          the same, and few tries a minute from an address            guessed_links
replayed link          a link is spent once, in one transaction                    a_replayed_link
link read ahead        a link is spent by a button, not by being fetched           a_link_read_ahead
link that leaks        no log of requests, no referrer to other sites              a_link_that_leaks
stolen database        digests of tokens, and no tokens, in a file for its owner   a_stolen_database
forged session         as links; renewing a link ends its session                  a_forged_session
own team's artifact    refused by a trigger of the database                        a_vote_for_the_own_team
second ballot          the voter is the ballot's key                               a_second_ballot
too many votes         refused by a trigger of the database                        too_many_votes
pair of one's choice   the gallery asks, and accepts no other pair                 a_pair_of_ones_choice
second answer          voter and pair are the answer's key                         a_second_answer
votes for nothing      a foreign key                                               a_vote_for_no_artifact
late ballot            the server's clock, read within the transaction             a_late_ballot
others' ballots        no page shows a ballot but one's own; results count them    the_ballots_of_others
results before time    refused until the end                                       results_before_the_end
script in a name       escaping, a policy without inline script                    script_in_a_name
script in a title      the same, and one plain line                                script_in_a_title
SVG as artifact        JPEG, PNG and TIFF alone, told by content                   svg_as_an_artifact
EXIF of an artifact    pictures are encoded anew from pixels                       exif_of_an_artifact
polyglot artifact      the same                                                    a_polyglot
decompression bomb     sizes judged by the header, before anything is allocated    a_decompression_bomb
link as an artifact    plain files alone                                           a_link_as_an_artifact
path traversal         names are looked up, and never joined to a path             path_traversal
oversize form          bytes counted as they come                                  an_oversize_form
slow form              ten seconds for all of it                                   a_slow_form
half a request         ten seconds for its head; when full, the oldest is closed   half_a_request
full log               three files of a megabyte                                   a_full_log
CSRF                   origin, key of the session, kind of content, SameSite       csrf
SQL injection          parameters alone                                            sql_injection
clickjacking           frame-ancestors 'none'                                      clickjacking
enumeration            addresses keyed by a secret; the same answer to all         enumeration
header injection       one host's name, redirects to constants, strict parsing     header_injection
forged client address  a proxy is believed where one is stated                     a_forged_client_address
flood by a voter       so many requests and ballots of each session                a_flood
formulas in a table    cells are text                                              formulas_in_a_table
archive with traps     see submissions/archives/unpack.py               an_archive_with_traps
another's artifact     the file's name says whose it is, not what stands in it     anothers_artifact
votes erased           a picture that is replaced keeps its votes, uncounted       votes_erased
=====================  ==========================================================  ======================

What it does not stop: somebody who is given another's link votes with it, and who can read the
network votes too unless a proxy adds TLS. A flood that fills the line, or the processor, is a
proxy's to stop.
"""
