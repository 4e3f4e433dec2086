// What the pages with Python share (try.js, photos.js): the worker, and the progress of loading.

// Start a worker. Events of an ended worker may still arrive. They are ignored, so that they cannot
// end its successor: `getCurrent()` returns the worker that the page uses now.
function startWorker(url, getCurrent, receive, fail) {
  const worker = new Worker(url);
  worker.onmessage = (event) => {
    if (getCurrent() === worker) receive(event);
  };
  worker.onerror = () => {
    if (getCurrent() === worker) fail();
  };
  return worker;
}

// Show how much of Python is loaded, in a progress bar and in words. python_loader.js sends the
// numbers: `what` is being loaded, `loaded` and `total` are bytes.
function showLoading(box, { what, loaded, total }) {
  const bar = box.querySelector("progress");
  const megabytes = (bytes) => (bytes / 1e6).toFixed(0);
  bar.hidden = false;
  if (total) {
    bar.max = total;
    bar.value = Math.min(loaded, total);
  } else {
    bar.removeAttribute("value");
  }
  const amount = total
    ? `${megabytes(loaded)} of ${megabytes(total)} MB`
    : `${megabytes(loaded)} MB`;
  // as a value of the bar, which a screen reader does not announce at each megabyte
  bar.setAttribute("aria-valuetext", amount);
  box.querySelector(".state").textContent = `Loading ${what}`;
  bar.title = amount;
  box.style.setProperty("--amount", JSON.stringify(`: ${amount}`));
  box.classList.add("loading");
}
