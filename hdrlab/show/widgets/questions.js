// Shared by the kinds of questions: colors and tolerances. Each kind appends its controls, and
// returns
//   read()           the answer, or null if the reader gave none
//   show(answer)     shows an answer that was given earlier
//   reveal()         shows the true answer over the reader's, and takes no other answer
//   compare(answer)  { isNear, words }: whether the answer counts, and how far it is from the truth

const ANSWER_COLOR = "#0063a0"; // of the reader's answer
const TRUTH_COLOR = "#d55e00";
const NEAR_FRACTION = 0.1; // of the scale: an answer this near to the truth counts
