// Python for the boxes "Try it" (try.js): it loads what each check needs, and runs the checks.
importScripts("python_loader.js");
const { tell } = pythonLoader;

function check(python, task, text, draw) {
  tell("checking");
  const answer = python.pyimport("hdrlab.course.site.lite.in_browser").check_as_json;
  return JSON.parse(answer(task, text, draw));
}

async function answer({ lite, task, text, packages }) {
  const python = await pythonLoader.start(lite);
  await pythonLoader.add(packages, packages.join(" and "));
  // what the text itself imports
  await python.loadPackagesFromImports(text, { messageCallback: () => {} });
  const { figures } = pythonLoader.manifest();
  const hasFigures = pythonLoader.has(figures);
  const result = check(python, task, text, hasFigures);
  const wantsFigures = !result.isRight && !hasFigures && !result.isBroken;
  tell("feedback", { ...result, isLast: !wantsFigures });
  if (!wantsFigures) return;
  // matplotlib is large: the words come first, and stay if the figures cannot be drawn
  try {
    await pythonLoader.add([figures], "what draws the figures");
    tell("feedback", { ...check(python, task, text, true), isLast: true });
  } catch (error) {
    console.warn(`${error}`);
    tell("feedback", { ...result, isLast: true });
  }
}

onmessage = ({ data }) =>
  answer(data).catch((error) => tell("failed", { message: pythonLoader.describe(error) }));
