"""Export the widgets of an executed notebook, so that a web page runs them without a kernel.

Each widget becomes a file with its state; widgets of one kind share a file with their script. The
page shows an image in the widget's place, before its script has run and on paper.

The files are scripts, not JSON, because a page that was opened from a folder may not read other
files. Binary data is written as text, 15 bits per letter: in UTF-16 that adds a fifteenth to the
size, where base64 adds a third.
"""

import base64
import hashlib
import json
import re
from collections.abc import Iterator
from html import escape
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hdrlab.io import files, web
from hdrlab.show.pictures import encode_change, is_ink

VIEW = "application/vnd.jupyter.widget-view+json"
STATE = "application/vnd.jupyter.widget-state+json"
# traits that are not exported: those of every widget, and the current frame, which is stored twice
SKIPPED_TRAITS = ("layout", "tabbable", "tooltip", "frame")
IMAGE_TRAITS = ("stored", "frames", "picture", "pictures")
BITS_PER_LETTER = 15
FIRST_LETTER = 0x3000  # no letter from here on has a meaning in a script
LESS_THAN = "\\u003c"  # in a string of JSON
BYTES = re.compile(r'{"base64": "([^"]*)"}')
EMBEDDED = re.compile(r'src="data:image/(webp|jpeg);base64,([^"]+)"(?: data-ink)?')


class ExportedWidget(NamedTuple):
    """An exported widget.

    Attributes
    ----------
    name : name of its files
    script, style : JavaScript and CSS
    state : its traits; bytes are {"base64": text}, and the first frame is {"shown": true}, because
        the page shows it already
    picture : the image in its place; empty for a question without one
    alt : alt text
    """

    name: str
    script: str
    style: str
    state: dict[str, Any]
    picture: bytes
    alt: str

    @property
    def code(self) -> str:
        """Name of the file with its script and style."""
        return f"code-{hashlib.sha256((self.script + self.style).encode()).hexdigest()[:16]}"

    @property
    def question(self) -> str:
        """The question that the widget asks, "" if it asks none."""
        return str(self.state.get("question", ""))

    def as_html(self, folder: str) -> str:
        """Return the HTML of the widget; `folder` is the address of its files."""
        asks = f' data-asks="{escape(self.question)}"' if self.question else ""
        return self._place(f"{folder}/{self.name}.webp", f"{folder}/", asks)

    def as_embedded_html(self) -> str:
        """Return the HTML of the widget, for a page that contains its image and its `scripts`.

        Such a page forgets the answer to a question when it is closed.
        """
        return self._place(web.data_uri(self.picture) if self.picture else "", "", "")

    def _place(self, picture: str, folder: str, asks: str) -> str:
        """Return the HTML of the widget's place, with its image or alt text."""
        still = f"<p>{escape(self.alt)}</p>"
        if self.picture:
            attributes = f'alt="{escape(self.alt)}" {_image_attributes(self.picture)}'
            still = f'<img src="{picture}" {attributes} loading="lazy">'
        scripts = f'data-code="{folder}{self.code}.js" data-from="{folder}{self.name}.js"'
        return f'<div class="live" data-name="{self.name}"{asks} {scripts}>{still}</div>'

    def scripts(self) -> dict[str, str]:
        """Return the widget's scripts by the names of their files: its code, and then its state.

        Bytes are {"base64": text}. No script contains a "<", so that a page can contain it.
        """
        code = json.dumps({"script": self.script, "style": self.style})
        state = json.dumps({"code": self.code, "state": self.state})
        contents = {self.code: code, self.name: state}
        return {
            f"{name}.js": f'hdrlab.take("{name}", {content.replace("<", LESS_THAN)});\n'
            for name, content in contents.items()
        }


def widgets(notebook: Any, name: str) -> Iterator[tuple[Any, ExportedWidget]]:
    """Yield each output of an executed notebook that shows a widget of hdrlab, and the widget."""
    models = notebook.metadata.get("widgets", {}).get(STATE, {}).get("state", {})
    shown = (output for output in _outputs(notebook) if VIEW in output.get("data", {}))
    for number, output in enumerate(shown):
        model = models.get(output["data"][VIEW]["model_id"])
        if model is not None and "_esm" in model["state"]:
            yield output, export_widget(model, f"{name}-{number + 1}")


def export_widget(model: Any, name: str) -> ExportedWidget:
    """Return the exported widget from its model in a notebook's metadata."""
    record = json.loads(json.dumps(model))
    state = record["state"]
    for buffer in record.get("buffers", []):
        *path, last = buffer["path"]
        place = state
        for step in path:
            place = place[step]
        place[last] = {"base64": buffer["data"]}
    traits = {
        key: value
        for key, value in state.items()
        if not key.startswith("_") and key not in SKIPPED_TRAITS
    }
    no_image = {"base64": ""}  # as in a question without one
    shown = next((traits[key] for key in IMAGE_TRAITS if traits.get(key)), no_image)
    if isinstance(shown, list):
        shown = shown[0]
    picture = base64.b64decode(shown["base64"])
    is_comparison = "scales" in traits  # its images are stored without loss
    if is_comparison:
        picture = encode_change(web.decode_picture(picture))
        traits["pictures"] = [
            {"base64": _compress_if_photo(image["base64"])} for image in traits["pictures"]
        ]
    for key in {"stored", "frames"} & traits.keys():
        traits[key] = [{"shown": True}, *traits[key][1:]]
    return ExportedWidget(
        name=name,
        script=state["_esm"],
        style=state.get("_css", ""),
        state=traits,
        picture=picture,
        alt=_alt_text(traits),
    )


def _alt_text(traits: dict[str, Any]) -> str:
    """Return the alt text of a widget: its question, or that of its first image."""
    if traits.get("question"):
        return traits["question"]
    return traits["alts"][0] if "alts" in traits else traits["alt"]


def _compress_if_photo(lossless: str) -> str:
    """Return a lossless image (base64) as JPEG where that takes fewer bytes, as for a photo."""
    picture = base64.b64decode(lossless)
    lossy = web.encode_jpeg(web.decode_picture(picture), quality=95)
    return base64.b64encode(min(picture, lossy, key=len)).decode()


def _image_attributes(picture: bytes) -> str:
    """Return the HTML attributes of an image: its size, and whether a dark page may invert it."""
    shown = web.decode_picture(picture)
    height, width, _ = shown.shape
    ink = " data-ink" if is_ink(shown) else ""
    return f'width="{width}" height="{height}"{ink}'


def extract_images(notebook: Any, name: str, folder: Path, address: str) -> None:
    """Move the images embedded in an executed notebook's HTML to files, which pages load lazily.

    `address` is the address of the folder, as seen from the page.
    """
    number = count(1)

    def move(embedded: re.Match[str]) -> str:
        picture = base64.b64decode(embedded[2])
        file = f"{name}-p{next(number)}.{embedded[1]}"
        write_changed(folder / file, picture)
        return f'src="{address}/{file}" {_image_attributes(picture)} loading="lazy"'

    for output in _outputs(notebook):
        data = output.get("data", {})
        if "text/html" in data:
            data["text/html"] = EMBEDDED.sub(move, "".join(data["text/html"]))


def write_widget(widget: ExportedWidget, folder: Path) -> None:
    """Write the files of a widget; unchanged files are left alone."""
    code, state = widget.scripts().values()
    write_changed(folder / f"{widget.code}.js", code.encode())
    state = BYTES.sub(_encode_as_letters, state)
    write_changed(folder / f"{widget.name}.js", state.encode("utf-16"))
    if widget.picture:
        write_changed(folder / f"{widget.name}.webp", widget.picture)


def _encode_as_letters(encoded: re.Match[str]) -> str:
    """Return base64 data as text with 15 bits per letter."""
    data = base64.b64decode(encoded[1])
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    padded = np.pad(bits, (0, -len(bits) % BITS_PER_LETTER)).reshape(-1, BITS_PER_LETTER)
    values = padded @ (1 << np.arange(BITS_PER_LETTER)[::-1])
    letters = (values + FIRST_LETTER).astype("<u2").tobytes().decode("utf-16-le")
    return f'{{"letters": "{letters}", "length": {len(data)}}}'


def write_changed(path: Path, content: bytes) -> None:
    """Write a file unless it has this content: its time shows whether a page must be rebuilt."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_bytes() != content:
        files.write(path, content)


def _outputs(notebook: Any) -> Iterator[Any]:
    for cell in notebook.cells:
        yield from cell.get("outputs", [])
