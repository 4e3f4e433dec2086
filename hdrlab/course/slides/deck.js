// Starts reveal.js, gives each figure the size that its slide leaves, and lets widgets have the keyboard.
(() => {
  const WIDTHS = [400, 480, 640, 800, 960, 1168]; // px, at which a figure is tried
  const PRINTED_WIDTH = 800; // px, of what a cell prints
  const MAX_SCALE = 2.2;
  const GOOD_SCALE = 1.3; // at which the letters of a widget are read from the last row
  const MIN_LETTERS = 20; // px

  // The area of the images of a figure, in its own pixels.
  const areaOf = (sized) =>
    [...sized.querySelectorAll("img, canvas, svg")].reduce((sum, image) => {
      const { width, height } = image.getBoundingClientRect();
      return sum + width * height;
    }, 0);

  function apply(sized, { width, scale }, room) {
    sized.style.width = `${width}px`;
    sized.style.transform = `translate(${(room.width - width * scale) / 2}px) scale(${scale})`;
  }

  // Lay a figure out at several widths, and keep that at which its images and its letters become large.
  function fit(sized) {
    const room = { width: sized.parentElement.clientWidth, height: sized.parentElement.clientHeight };
    if (room.width === 0) return; // not shown
    let best = { size: 0 };
    const widths = sized.querySelector("img, .live, figure") ? WIDTHS : [PRINTED_WIDTH];
    for (const width of widths) {
      apply(sized, { width, scale: 1 }, room);
      const measured = sized.getBoundingClientRect();
      const unit = measured.width / width; // the scale of the whole deck
      const scale = Math.min(room.width / width, room.height / (measured.height / unit), MAX_SCALE);
      const area = (areaOf(sized) / unit ** 2 || 1) * scale ** 2;
      const size = area * Math.min(scale, GOOD_SCALE); // small letters count against a width
      if (size > 1.02 * best.size) best = { size, width, scale };
    }
    apply(sized, best, room);
    sized.dataset.height = sized.offsetHeight;
  }

  // Text that is longer than estimated gets smaller letters.
  function fitText(text) {
    for (let size = 29; size >= MIN_LETTERS && text.scrollHeight > text.clientHeight + 1; size--)
      text.style.fontSize = `${size}px`;
  }

  const fitAll = (part) => {
    part?.querySelectorAll(".text").forEach(fitText);
    part?.querySelectorAll(".sized").forEach(fit);
  };

  // A widget that has opened, or says more than before, may need more room.
  const grown = new ResizeObserver((entries) => {
    for (const { target } of entries)
      if (target.offsetHeight > Number(target.dataset.height ?? 0) + 1) fit(target);
  });
  const opened = new MutationObserver((changes) => {
    for (const { target } of changes) fit(target.closest(".sized"));
  });
  for (const sized of document.querySelectorAll(".sized")) grown.observe(sized);
  for (const place of document.querySelectorAll(".live"))
    opened.observe(place, { attributes: true, attributeFilter: ["data-state"] });

  // A remote control sends Page Up and Page Down: they turn the page from within a widget, too, which would keep them
  // for itself. Escape leaves the widget.
  const TURNS = { PageUp: () => Reveal.prev(), PageDown: () => Reveal.next(), Escape: () => {} };
  const inWidget = () => document.activeElement?.closest(".live");
  const leave = () => inWidget() && document.activeElement.blur();
  function turn(event) {
    if (!inWidget() || !(event.key in TURNS)) return;
    event.preventDefault();
    event.stopPropagation();
    leave();
    TURNS[event.key]();
  }
  addEventListener("keydown", turn, true);

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
    keyboardCondition: () => !inWidget(),
    plugins: [RevealNotes],
  }).then(() => fitAll(Reveal.getCurrentSlide()));
  Reveal.on("slidechanged", ({ currentSlide }) => {
    leave();
    fitAll(currentSlide);
  });
  Reveal.on("pdf-ready", () => fitAll(document));
})();
