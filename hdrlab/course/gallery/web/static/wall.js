// The wall works without this. With it, each vote is saved when it is given, and the bar says so.
"use strict";

const ballot = document.getElementById("ballot");
const votes = [...ballot.querySelectorAll("input[name=mark]")];
const picks = [...document.querySelectorAll("input[name=with]")];
const state = document.getElementById("state");
const side = document.getElementById("side");
const most = Number(ballot.dataset.marks);
let saved = votes.filter((one) => one.defaultChecked);
let turn = 0;

const marked = () => votes.filter((one) => one.checked);

function say(text, wrong = false) {
  state.textContent = text;
  state.classList.toggle("wrong", wrong);
}

function show() {
  const full = marked().length >= most;
  for (const one of votes) {
    one.disabled = full && !one.checked;
    one.closest(".card").classList.toggle("chosen", one.checked);
  }
}

async function save() {
  const mine = ++turn;
  const now = marked();
  show();
  say("Saving…");
  try {
    const answer = await fetch("/ballot", {
      method: "POST",
      headers: { Accept: "application/json" },
      body: new URLSearchParams(new FormData(ballot)),
    });
    const found = await answer.json();
    if (!answer.ok) throw new Error(found.error);
    saved = now;
    const full = found.votes >= most ? " Remove one to vote for another artifact." : "";
    if (mine === turn) say(`${found.votes} of ${most} votes saved at ${found.when}.${full}`);
  } catch (error) {
    if (mine !== turn) return; // a later one is on its way
    for (const one of votes) one.checked = saved.includes(one);
    show();
    say(error instanceof TypeError ? "Not saved: the gallery does not answer. Try again." : `Not saved. ${error.message}`, true);
  }
}

function pick() {
  const two = picks.filter((one) => one.checked).length;
  for (const one of picks) one.disabled = two >= 2 && !one.checked;
  side.disabled = two !== 2;
  side.textContent = two === 1 ? "Compare: one more" : "Compare two";
}

for (const one of votes) one.addEventListener("change", save);
for (const one of picks) one.addEventListener("change", pick);
document.getElementById("save")?.remove(); // there is nothing left to save by hand
if (votes.some((one) => one.checked !== one.defaultChecked)) save(); // given before this was here
addEventListener("pageshow", () => { show(); pick(); });
