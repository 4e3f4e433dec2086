// Show in a box of the page how much of Python has come, as python_loader.js tells it: a bar, and words.
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
  const amount = total ? `${megabytes(loaded)} of ${megabytes(total)} MB` : `${megabytes(loaded)} MB`;
  // not each megabyte is read out
  bar.setAttribute("aria-valuetext", amount);
  box.querySelector(".state").textContent = `Loading ${what}`;
  bar.title = amount;
  box.style.setProperty("--amount", JSON.stringify(`: ${amount}`));
  box.classList.add("loading");
}
