// `widgets.blink`: images in the same place, one after the other, so that differences are seen.
//
// Python sends the traits of viewer.js and
//   period  how long each image is shown, seconds
// and both sides set
//   index   the image that is shown, from 0

async function render({ model, el }) {
  const root = createRoot(el, "blink");
  const labels = model.get("labels");
  const index = () => model.get("index");
  let timer = null;

  // Draw the current image, and return the words that describe what is drawn.
  function compose(_, drawImage) {
    drawImage(index());
    return labels[index()];
  }

  function handleKey(event) {
    if (event.key !== " ") return false;
    pause();
    showNext();
    return true;
  }

  const view = await createViewer(root, model, {
    help: `${labels.join(", ")}; Space shows the next`,
    hint:
      "To zoom, click and turn the wheel, or pinch; the arrow keys read single pixels, " +
      "Space shows the next picture.",
    compose,
    handleKey,
  });
  const { row, buttons, show: checkButton } = addRadioRow(view.controls, "picture", labels);
  const blinkButton = addElement(view.controls, "button", {
    type: "button",
    textContent: "Blink",
  });
  view.controls.prepend(blinkButton, row);
  buttons.forEach(({ input }, position) => {
    input.addEventListener("change", () => {
      pause();
      choose(position);
    });
  });

  function show() {
    checkButton(index());
    view.repaint();
  }

  function choose(position) {
    saveTrait(model, "index", position);
    show();
  }

  function showNext() {
    choose((index() + 1) % labels.length);
  }

  function pause() {
    clearInterval(timer);
    timer = null;
    blinkButton.textContent = "Blink";
  }

  function blink() {
    showNext();
    timer = setInterval(showNext, 1000 * model.get("period"));
    blinkButton.textContent = "Stop";
  }

  blinkButton.addEventListener("click", () => {
    if (timer === null) blink();
    else pause();
  });

  const stopListening = onTraitChange(model, ["index"], show);
  show();
  return () => {
    pause();
    stopListening();
  };
}

export default { render };
