// The wall of the gallery. It works without this script. With it, the page saves each vote at once,
// and the bar at the bottom says so.
"use strict";

const MAX_COMPARED = 2; // artifacts

const ballot = document.getElementById("ballot");
const voteBoxes = [...ballot.querySelectorAll("input[name=mark]")];
const compareBoxes = [...document.querySelectorAll("input[name=with]")];
const statusLine = document.getElementById("state");
const compareButton = document.getElementById("side");
const maxVotes = Number(ballot.dataset.marks);
let savedBoxes = voteBoxes.filter((box) => box.defaultChecked); // as the gallery knows them
let lastRequest = 0;

const checkedBoxes = () => voteBoxes.filter((box) => box.checked);

function showStatus(text, isError = false) {
  statusLine.textContent = text;
  statusLine.classList.toggle("wrong", isError);
}

// Mark the cards with a vote. Without votes left, the other boxes cannot be checked.
function showVotes() {
  const isFull = checkedBoxes().length >= maxVotes;
  for (const box of voteBoxes) {
    box.disabled = isFull && !box.checked;
    box.closest(".card").classList.toggle("chosen", box.checked);
  }
}

// Send the ballot, and return the gallery's answer.
async function sendBallot() {
  const response = await fetch("/ballot", {
    method: "POST",
    headers: { Accept: "application/json" },
    body: new URLSearchParams(new FormData(ballot)),
  });
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.error);
  return answer;
}

async function saveVotes() {
  lastRequest += 1;
  const request = lastRequest;
  const boxes = checkedBoxes();
  showVotes();
  showStatus("Saving…");
  try {
    const { votes, when } = await sendBallot();
    savedBoxes = boxes;
    const hint = votes >= maxVotes ? " Remove one to vote for another artifact." : "";
    const text = `${votes} of ${maxVotes} votes saved at ${when}.${hint}`;
    if (request === lastRequest) showStatus(text);
  } catch (error) {
    if (request !== lastRequest) return; // a later request will say what is saved
    for (const box of voteBoxes) box.checked = savedBoxes.includes(box);
    showVotes();
    const isNetworkError = error instanceof TypeError;
    const text = isNetworkError
      ? "Not saved: the gallery does not answer. Try again."
      : `Not saved. ${error.message}`;
    showStatus(text, true);
  }
}

// Enable the button once two artifacts are chosen, and then no third one.
function showCompared() {
  const count = compareBoxes.filter((box) => box.checked).length;
  for (const box of compareBoxes) box.disabled = count >= MAX_COMPARED && !box.checked;
  compareButton.disabled = count !== MAX_COMPARED;
  compareButton.textContent = count === 1 ? "Compare: one more" : "Compare two";
}

for (const box of voteBoxes) box.addEventListener("change", saveVotes);
for (const box of compareBoxes) box.addEventListener("change", showCompared);
document.getElementById("save")?.remove(); // the button that saves all votes
// Save votes that the reader gave before this script was loaded.
if (voteBoxes.some((box) => box.checked !== box.defaultChecked)) saveVotes();
addEventListener("pageshow", () => {
  showVotes();
  showCompared();
});
