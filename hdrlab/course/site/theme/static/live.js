// The widgets of a page, with no kernel: each is opened when it comes near the screen.
// A page from a folder may load scripts but read no files, so a widget's file is a script that calls `widget`.
(() => {
  const places = new Map();
  const styles = new Set();

  const unpack = (value) => {
    if (Array.isArray(value)) return value.map(unpack);
    if (value?.base64 === undefined) return value;
    return new DataView(Uint8Array.from(atob(value.base64), (letter) => letter.charCodeAt(0)).buffer);
  };

  // What a widget's script asks of its model: values, and who is told when one changes.
  function modelOf(state) {
    const listeners = {};
    return {
      get: (name) => state[name],
      set: (name, value) => {
        state[name] = value;
        for (const listener of listeners[`change:${name}`] ?? []) listener();
      },
      save_changes: () => {},
      on: (name, listener) => (listeners[name] ??= []).push(listener),
      off: (name, listener) => (listeners[name] = (listeners[name] ?? []).filter((one) => one !== listener)),
    };
  }

  const frame = () => new Promise(requestAnimationFrame);

  async function open(place, { script, style, state }) {
    if (!styles.has(style)) {
      styles.add(style);
      document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
    }
    const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    const { default: widget } = await import(address);
    URL.revokeObjectURL(address);
    const el = document.createElement("div");
    el.toggleAttribute("data-ink", place.querySelector("img[data-ink]") !== null); // and so is what is drawn in its place
    const values = Object.fromEntries(Object.entries(state).map(([name, value]) => [name, unpack(value)]));
    await widget.render({ model: modelOf(values), el });
    const waiting = () => el.querySelector("canvas")?.getAttribute("aria-label") === "";
    for (let k = 0; k < 120 && waiting(); k++) await frame();
    place.replaceChildren(el); // the picture that stood here until now is what the canvas begins with
    place.dataset.state = "open";
  }

  window.hdrlab = {
    running: `${document.documentElement.dataset.content_root}installing.html`,
    widget(name, content) {
      for (const place of places.get(name) ?? [])
        open(place, content).catch((error) => {
          place.dataset.state = "failed";
          console.error(error);
        });
    },
  };

  const near = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      near.unobserve(target);
      const { name, from } = target.dataset;
      places.set(name, [...(places.get(name) ?? []), target]);
      document.head.append(Object.assign(document.createElement("script"), { src: from }));
    }
  }, { rootMargin: "600px 0px" });

  // What is wider than the page is scrolled, so the keyboard must reach it.
  function reach() {
    for (const each of document.querySelectorAll("pre, table, div.math"))
      if (each.scrollWidth > each.clientWidth) each.tabIndex = 0;
      else each.removeAttribute("tabindex");
  }

  // A button that copies a cell; what stands behind a prompt is copied without it.
  function copyable(block) {
    const code = block.querySelector("pre");
    const button = Object.assign(document.createElement("button"), { className: "copy", textContent: "Copy" });
    button.addEventListener("click", async () => {
      const lines = code.textContent.trimEnd().split("\n");
      const asked = lines.filter((line) => /^(>>>|\.\.\.)( |$)/.test(line)).map((line) => line.slice(4));
      await navigator.clipboard.writeText((asked.length ? asked : lines).join("\n"));
      button.textContent = "Copied";
      setTimeout(() => (button.textContent = "Copy"), 2000);
    });
    block.append(button);
  }

  // Cells that only draw are folded; a switch opens all of them, on this page and on the next.
  function unfoldable(folds) {
    const button = Object.assign(document.createElement("button"), { className: "codes" });
    const set = (open) => {
      folds.forEach((fold) => (fold.open = open));
      button.textContent = open ? "Fold the code of pictures" : "Show all code";
      if (open) reach();
    };
    let open = false;
    try {
      open = localStorage.getItem("hdrlab-code") === "open";
    } catch {} // where a browser keeps nothing for a file, the switch is of this page alone
    button.addEventListener("click", () => {
      set((open = !open));
      try {
        localStorage.setItem("hdrlab-code", open ? "open" : "folded");
      } catch {}
    });
    set(open);
    for (const fold of folds) fold.querySelector("summary").removeAttribute("aria-label"); // its text says more
    document.querySelector("main h1").after(button);
  }

  // On paper an answer cannot be opened, so all are; afterwards they are as they were.
  const closed = () => document.querySelectorAll("main details:not(.hide):not([open])");
  let opened = [];
  addEventListener("beforeprint", () => (opened = [...closed()]).forEach((each) => (each.open = true)));
  addEventListener("afterprint", () => opened.forEach((each) => (each.open = false)));

  if (navigator.clipboard)
    document.querySelectorAll("main .highlight:not(.cell_output *)").forEach(copyable);
  const folds = document.querySelectorAll("main details.hide");
  if (folds.length) unfoldable(folds);
  document.querySelectorAll(".live").forEach((place) => near.observe(place));
  reach();
  addEventListener("resize", reach);
})();
