// The slides: start reveal.js, give each figure the size that its slide leaves, and let the widgets
// on a slide have the keyboard.
(() => {
  const TRIED_WIDTHS = [400, 480, 640, 800, 960, 1168]; // px, of a figure
  const PRINTED_WIDTH = 800; // px, of the text that a cell prints
  const MAX_SCALE = 2.2; // of a figure
  const READABLE_SCALE = 1.3; // at which a widget can be read from the last row
  const MIN_GAIN = 1.02; // another width must be this much better
  const MAX_LETTERS = 29; // px, of text that does not fit at its own size
  const MIN_LETTERS = 20; // px

  // The area of the images in a figure, px².
  function imageArea(figure) {
    let area = 0;
    for (const image of figure.querySelectorAll("img, canvas, svg")) {
      const { width, height } = image.getBoundingClientRect();
      area += width * height;
    }
    return area;
  }

  // Give a figure a width, scale it, and center it.
  function applySize(figure, { width, scale }, room) {
    const left = (room.width - width * scale) / 2;
    figure.style.width = `${width}px`;
    figure.style.transform = `translate(${left}px) scale(${scale})`;
  }

  // Lay out a figure at a width, and return the scale that fits the room, and how good this is: the
  // area of the images, reduced if the letters are small.
  function measure(figure, width, room) {
    applySize(figure, { width, scale: 1 }, room);
    const box = figure.getBoundingClientRect();
    const deckScale = box.width / width; // reveal.js scales the whole deck
    const height = box.height / deckScale;
    const scale = Math.min(room.width / width, room.height / height, MAX_SCALE);
    const area = (imageArea(figure) / deckScale ** 2 || 1) * scale ** 2;
    return { width, scale, quality: area * Math.min(scale, READABLE_SCALE) };
  }

  // Lay out a figure at several widths, and keep the best.
  function fitFigure(figure) {
    const { clientWidth, clientHeight } = figure.parentElement;
    const room = { width: clientWidth, height: clientHeight };
    if (room.width === 0) return; // the slide is not shown
    const hasImages = figure.querySelector("img, .live, figure") !== null;
    const widths = hasImages ? TRIED_WIDTHS : [PRINTED_WIDTH];
    let best = { quality: 0 };
    for (const width of widths) {
      const size = measure(figure, width, room);
      if (size.quality > MIN_GAIN * best.quality) best = size;
    }
    applySize(figure, best, room);
    figure.dataset.height = figure.offsetHeight;
  }

  // Reduce the letters of a text that does not fit.
  function fitText(text) {
    for (let size = MAX_LETTERS; size >= MIN_LETTERS; size--) {
      if (text.scrollHeight <= text.clientHeight + 1) return;
      text.style.fontSize = `${size}px`;
    }
  }

  // Fit the text and the figures of a slide, or of the whole document.
  function fitAll(part) {
    part?.querySelectorAll(".text").forEach(fitText);
    part?.querySelectorAll(".sized").forEach(fitFigure);
  }

  // Fit a figure again when it has grown, and when a widget in it has opened.
  const growthObserver = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const fittedHeight = Number(target.dataset.height ?? 0);
      if (target.offsetHeight > fittedHeight + 1) fitFigure(target);
    }
  });
  const openingObserver = new MutationObserver((changes) => {
    for (const { target } of changes) fitFigure(target.closest(".sized"));
  });
  for (const figure of document.querySelectorAll(".sized")) growthObserver.observe(figure);
  for (const place of document.querySelectorAll(".live")) {
    openingObserver.observe(place, { attributes: true, attributeFilter: ["data-state"] });
  }

  const isInWidget = () => Boolean(document.activeElement?.closest(".live"));

  function leaveWidget() {
    if (isInWidget()) document.activeElement.blur();
  }

  // A remote control sends Page Up and Page Down. They also change the slide while a widget has the
  // focus, which would otherwise use them itself. Escape leaves the widget.
  const WIDGET_KEYS = {
    PageUp: () => Reveal.prev(),
    PageDown: () => Reveal.next(),
    Escape: () => {},
  };
  function handleKeyInWidget(event) {
    if (!isInWidget() || !(event.key in WIDGET_KEYS)) return;
    event.preventDefault();
    event.stopPropagation();
    leaveWidget();
    WIDGET_KEYS[event.key]();
  }
  addEventListener("keydown", handleKeyInWidget, true);

  Reveal.initialize({
    width: 1280,
    height: 720,
    margin: 0,
    maxScale: 4,
    center: false,
    controls: false,
    hash: true,
    slideNumber: "c/t",
    transition: "none",
    backgroundTransition: "none",
    keyboardCondition: () => !isInWidget(),
    plugins: [RevealNotes],
  }).then(() => fitAll(Reveal.getCurrentSlide()));
  Reveal.on("slidechanged", ({ currentSlide }) => {
    leaveWidget();
    fitAll(currentSlide);
  });
  Reveal.on("pdf-ready", () => fitAll(document));
})();
