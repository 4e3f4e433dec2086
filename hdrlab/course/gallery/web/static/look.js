// The page that shows one image of the gallery, or two next to each other. Buttons, keys, the wheel
// and a double click zoom; drag, keys and touch move. Two panes zoom and move together.
"use strict";

const MAX_ZOOM = 8; // 1 fits the image into its pane
const ZOOM_STEP = 1.25; // of a button or a key
const DOUBLE_CLICK_ZOOM = 3;
const WHEEL_SCALE = 400; // deltaY that zooms by a factor of e

const panes = [...document.querySelectorAll(".pane")];
const label = document.getElementById("zoom");
let zoom = 1;

document.querySelector(".zoom").hidden = false;

// The width of the image of a pane if it fits into the pane.
function fittedWidth(pane) {
  const image = pane.firstElementChild;
  const width = Number(image.getAttribute("width"));
  const height = Number(image.getAttribute("height"));
  return width * Math.min(pane.clientWidth / width, pane.clientHeight / height, 1);
}

// The point of the image in the middle of a pane, as fractions of its width and height.
function centerOf(pane) {
  return [
    (pane.scrollLeft + pane.clientWidth / 2) / pane.scrollWidth,
    (pane.scrollTop + pane.clientHeight / 2) / pane.scrollHeight,
  ];
}

// Scroll a pane so that this point of the image is in its middle.
function centerOn(pane, [x, y]) {
  pane.scrollTo({
    left: x * pane.scrollWidth - pane.clientWidth / 2,
    top: y * pane.scrollHeight - pane.clientHeight / 2,
    behavior: "instant",
  });
}

function setZoom(newZoom) {
  const center = centerOf(panes[0]);
  zoom = Math.min(MAX_ZOOM, Math.max(1, newZoom));
  const isZoomed = zoom > 1;
  for (const pane of panes) {
    const image = pane.firstElementChild;
    // Measure the pane without scroll bars.
    pane.classList.remove("near");
    image.style.width = "";
    const width = fittedWidth(pane);
    pane.classList.toggle("near", isZoomed);
    image.style.width = isZoomed ? `${width * zoom}px` : "";
    centerOn(pane, center);
  }
  label.textContent = isZoomed ? `${Math.round(100 * zoom)} %` : "Fit";
}

const zoomIn = () => setZoom(zoom * ZOOM_STEP);
const zoomOut = () => setZoom(zoom / ZOOM_STEP);
const fit = () => setZoom(1);
const BUTTON_ACTIONS = { in: zoomIn, out: zoomOut, fit };
const KEY_ACTIONS = { "+": zoomIn, "=": zoomIn, "-": zoomOut, 0: fit };

for (const button of document.querySelectorAll("[data-zoom]")) {
  button.addEventListener("click", BUTTON_ACTIONS[button.dataset.zoom]);
}

addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "Escape") {
    document.querySelector(".tools a").click(); // back to the wall
    return;
  }
  const action = KEY_ACTIONS[event.key];
  if (!action) return;
  action();
  event.preventDefault();
});

function handleWheel(event) {
  event.preventDefault();
  setZoom(zoom * Math.exp(-event.deltaY / WHEEL_SCALE));
}

// Scroll the other pane, too. This also runs for the pane that is scrolled in this way, which the
// reader does not touch.
function scrollOthers(pane) {
  const touched = panes.find((candidate) => candidate.matches(":hover, :focus"));
  if (pane !== touched) return;
  for (const other of panes) {
    if (other !== pane) centerOn(other, centerOf(pane));
  }
}

// The browser itself scrolls for touch, but not for a mouse.
function startMouseDrag(event) {
  if (event.pointerType === "mouse") event.currentTarget.setPointerCapture(event.pointerId);
}

function dragByMouse(event) {
  const pane = event.currentTarget;
  if (event.pointerType !== "mouse" || !pane.hasPointerCapture(event.pointerId)) return;
  pane.scrollBy({ left: -event.movementX, top: -event.movementY, behavior: "instant" });
}

for (const pane of panes) {
  pane.addEventListener("wheel", handleWheel, { passive: false });
  pane.addEventListener("dblclick", () => setZoom(zoom > 1 ? 1 : DOUBLE_CLICK_ZOOM));
  pane.addEventListener("scroll", () => scrollOthers(pane));
  pane.addEventListener("pointerdown", startMouseDrag);
  pane.addEventListener("pointermove", dragByMouse);
}
addEventListener("resize", () => setZoom(zoom));
