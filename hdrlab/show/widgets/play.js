// `widgets.play`: the steps of an algorithm as frames, with a slider and a button that plays them.
//
// Python sends
//   frames  WebP, one for each step
//   alts    the alternative text of each frame
//   name    what the slider counts, such as "step"
//   areas   the maps in the frames, see addPicture
// and both sides set
//   index   the frame that is shown, from 0

const FRAMES_PER_SECOND = 8;

function render({ model, el }) {
  const root = createRoot(el, "play");
  const alts = model.get("alts");
  const count = model.get("frames").length;
  // Decode all frames now, so that a step never waits for Python or for the decoder.
  const frames = model.get("frames").map((bytes) => decodeImage(bytes, "image/webp"));
  frames.forEach(async (promise, step) => {
    frames[step] = await promise;
  });

  const view = addPicture(root, model.get("areas"));
  const controls = addElement(root, "div", { className: "hdrlab-controls" });
  const button = addElement(controls, "button", { type: "button", textContent: "Play" });
  const slider = addSlider(controls, model.get("name"), count);
  let timer = null;

  function show(step) {
    slider.show(step, `${step + 1} of ${count}`);
    view.show(frames[step], alts[step]);
  }

  function moveTo(step) {
    show(step);
    saveTrait(model, "index", step);
  }

  function pause() {
    clearInterval(timer);
    timer = null;
    button.textContent = "Play";
  }

  function advance() {
    const step = slider.position() + 1;
    if (step < count) moveTo(step);
    if (step >= count - 1) pause();
  }

  function play() {
    if (slider.position() === count - 1) moveTo(0);
    timer = setInterval(advance, 1000 / FRAMES_PER_SECOND);
    button.textContent = "Pause";
  }

  slider.input.addEventListener("input", () => {
    pause();
    moveTo(slider.position());
  });
  button.addEventListener("click", () => {
    if (timer === null) play();
    else pause();
  });
  const stopListening = onTraitChange(model, ["index"], () => {
    if (model.get("index") !== slider.position()) show(model.get("index"));
  });
  show(model.get("index"));
  return () => {
    pause();
    stopListening();
  };
}

export default { render };
