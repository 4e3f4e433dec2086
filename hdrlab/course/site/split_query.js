// Split a search query into words, as `SearchTokenizer.split` in words.py does for the pages. A
// Greek letter becomes its name: words.py defines `greek` before this script. g(Z) is one word.
const QUERY_WORD = /(?<![\p{L}\p{N}_])[a-z]\([a-z]\)|[\p{L}\p{N}_]+/giu;
var splitQuery = (query) => {
  const text = query.replace(/[α-ω]/g, (letter) => ` ${greek[letter] ?? letter} `);
  return text.match(QUERY_WORD) ?? [];
};
