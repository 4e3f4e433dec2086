var splitQuery = (query) =>
  query.replace(/[α-ω]/g, (letter) => ` ${greek[letter] ?? letter} `)
    .match(/(?<![\p{L}\p{N}_])[a-z]\([a-z]\)|[\p{L}\p{N}_]+/giu) ?? [];
