// Steps of an algorithm: all frames are here from the start, so moving through them asks nobody.

const PER_SECOND = 8;

function render({ model, el }) {
  const root = start(el, "play");
  const [name, count] = [model.get("name"), model.get("frames").length];
  const frames = model.get("frames").map((bytes) => decode(bytes, "image/webp"));
  frames.forEach((waiting, i) => waiting.then((bitmap) => (frames[i] = bitmap)));

  const view = picture(root, model.get("areas"));
  const controls = element(root, "div", { className: "hdrlab-controls" });
  const button = element(controls, "button", { type: "button", textContent: "Play" });
  const bar = slider(controls, name, count);
  let timer = null;

  function show(step) {
    bar.show(step, `${step + 1} of ${count}`);
    view.show(frames[step], model.get("alts")[step]);
  }

  function move(step) {
    show(step);
    model.set("index", step);
    model.save_changes();
  }

  function pause() {
    clearInterval(timer);
    timer = null;
    button.textContent = "Play";
  }

  function advance() {
    const step = Number(bar.input.value) + 1;
    if (step < count) move(step);
    if (step >= count - 1) pause();
  }

  function play() {
    if (Number(bar.input.value) === count - 1) move(0);
    timer = setInterval(advance, 1000 / PER_SECOND);
    button.textContent = "Pause";
  }

  const follow = () => {
    if (model.get("index") !== Number(bar.input.value)) show(model.get("index"));
  };
  bar.input.addEventListener("input", () => {
    pause();
    move(Number(bar.input.value));
  });
  button.addEventListener("click", () => (timer === null ? play() : pause()));
  model.on("change:index", follow);
  show(model.get("index"));
  return () => {
    pause();
    model.off("change:index", follow);
  };
}

export default { render };
