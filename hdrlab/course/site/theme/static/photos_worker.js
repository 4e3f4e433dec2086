// Python for a reader's own photos (photos.js): it calls hdrlab/course/site/lite/own_photos.py.
// Messages are answered one after the other; each answer has the kind of its message.
importScripts("python_loader.js");
const { tell } = pythonLoader;
const FOLDER = "/home/pyodide/own_photos";
const SCIKIT_IMAGE = "scikit-image";
let python = null;
let photos = null; // the object of Python that has the photos and the map

async function start(lite) {
  if (photos) return;
  python = await pythonLoader.start(lite);
  await pythonLoader.add(["scipy"], "SciPy");
  tell("stage", { text: "Starting hdrlab" });
  photos = python.pyimport("hdrlab.course.site.lite.own_photos").OwnPhotos(FOLDER);
}

const readFile = (name) => new Blob([python.FS.readFile(`${FOLDER}/${name}`)]);

const report = (text, done, total) => tell("stage", { text, done, total });

// Photos that are turned or tilted need scikit-image, which is large. A site may lack it.
async function assemble(times) {
  const result = JSON.parse(photos.assemble(times, report));
  if (!result.isMissing) return result;
  try {
    await pythonLoader.add([SCIKIT_IMAGE], "what turns the photos");
    return JSON.parse(photos.assemble(times, report));
  } catch (error) {
    console.warn(`${error}`);
  }
  const shifted = JSON.parse(photos.assemble.callKwargs(times, report, { align: "mtb" }));
  shifted.notes?.push("this page shifts the photos only, because scikit-image could not be loaded");
  return shifted;
}

const pictures = () => ({ png: readFile("tone_mapped.png"), jpg: readFile("tone_mapped.jpg") });

const ANSWERS = {
  async add({ name, file }) {
    tell("stage", { text: `Reading ${name}` });
    try {
      python.FS.writeFile(`${FOLDER}/photos/${name}`, new Uint8Array(await file.arrayBuffer()));
    } catch (error) {
      console.warn(`${error}`);
      return { error: `${name}: the browser cannot read this file` }; // a folder, for example
    }
    return JSON.parse(photos.add(name));
  },
  remove({ name }) {
    photos.remove(name);
    return {};
  },
  async assemble({ times }) {
    const result = await assemble(JSON.stringify(times));
    return result.error ? result : { ...result, ...pictures() };
  },
  map() {
    const result = JSON.parse(photos.write_map());
    return result.error ? result : { map: readFile("radiance_map.hdr") };
  },
  toneMap({ operator }) {
    const result = JSON.parse(photos.tone_map(operator));
    return result.error ? result : { ...result, ...pictures() };
  },
  expose({ stops }) {
    const result = JSON.parse(photos.expose(stops));
    return result.error ? result : { ...result, jpg: readFile("one_exposure.jpg") };
  },
};

async function answer(data) {
  try {
    await start(data.lite);
    const result = await ANSWERS[data.kind](data);
    tell(data.kind, { ...result, id: data.id });
  } catch (error) {
    console.warn(`${error}`);
    tell("failed", { message: pythonLoader.describe(error) });
  }
}

let queue = Promise.resolve();
onmessage = ({ data }) => {
  queue = queue.then(() => answer(data));
};
