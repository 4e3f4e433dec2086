// A closer look: zoom by buttons, keys, wheel and double click; move by drag, keys and touch. Two panes move as one.
"use strict";

const panes = [...document.querySelectorAll(".pane")];
const label = document.getElementById("zoom");
const STEP = 1.25;
const MOST = 8;
let factor = 1; // 1 fits the picture into its pane

document.querySelector(".zoom").hidden = false;

function fitted(pane) {
  const image = pane.firstElementChild;
  const [width, height] = [image.getAttribute("width"), image.getAttribute("height")].map(Number);
  return width * Math.min(pane.clientWidth / width, pane.clientHeight / height, 1);
}

function centre(pane) {
  return [(pane.scrollLeft + pane.clientWidth / 2) / pane.scrollWidth, (pane.scrollTop + pane.clientHeight / 2) / pane.scrollHeight];
}

function move(pane, [x, y]) {
  pane.scrollTo({ left: x * pane.scrollWidth - pane.clientWidth / 2, top: y * pane.scrollHeight - pane.clientHeight / 2, behavior: "instant" });
}

function zoom(wanted, at = centre(panes[0])) {
  const next = Math.min(MOST, Math.max(1, wanted));
  for (const pane of panes) {
    const image = pane.firstElementChild;
    pane.classList.remove("near");
    image.style.width = "";
    const width = fitted(pane);
    pane.classList.toggle("near", next > 1);
    image.style.width = next > 1 ? `${width * next}px` : "";
    move(pane, at);
  }
  factor = next;
  label.textContent = next > 1 ? `${Math.round(100 * next)} %` : "Fit";
}

const acts = { in: () => zoom(factor * STEP), out: () => zoom(factor / STEP), fit: () => zoom(1) };
for (const button of document.querySelectorAll("[data-zoom]")) button.addEventListener("click", acts[button.dataset.zoom]);

addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const act = { "+": acts.in, "=": acts.in, "-": acts.out, 0: acts.fit }[event.key];
  if (act) { act(); event.preventDefault(); }
  else if (event.key === "Escape") document.querySelector(".tools a").click();
});

for (const pane of panes) {
  pane.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(factor * Math.exp(-event.deltaY / 400));
  }, { passive: false });
  pane.addEventListener("dblclick", () => zoom(factor > 1 ? 1 : 3));
  pane.addEventListener("scroll", () => {
    if (pane !== panes.find((one) => one.matches(":hover, :focus"))) return; // it was moved by another
    for (const other of panes) if (other !== pane) move(other, centre(pane));
  });
  pane.addEventListener("pointerdown", (event) => { if (event.pointerType === "mouse") pane.setPointerCapture(event.pointerId); });
  pane.addEventListener("pointermove", (event) => {
    if (event.pointerType === "mouse" && pane.hasPointerCapture(event.pointerId)) pane.scrollBy({ left: -event.movementX, top: -event.movementY, behavior: "instant" });
  });
}
addEventListener("resize", () => zoom(factor));
