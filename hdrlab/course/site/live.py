"""A notebook's widgets, taken out of it: each becomes a file of its own, which its page opens with no kernel.

Widgets of one kind share their script, a file of its own, too.

The page carries a picture in the widget's place, so that it is whole before its script has run, and
on paper. The file is a script and not JSON, since a page that was opened from a folder may read no
other file. Its bytes are text, fifteen bits a letter: in UTF-16 that is a fifteenth more than they
are; base64 is a third.
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
# traits of every widget, and what a slider stores again
NOT_OWN = (
    "layout",
    "tabbable",
    "tooltip",
    "frame",
)
PICTURES = ("stored", "frames", "picture", "pictures")  # where our widgets keep what they show
# bits of a letter, and the letter of 0: none of them means anything in a script
LETTER = 15
FIRST = 0x3000
BYTES = re.compile(r'{"base64": "([^"]*)"}')
EMBEDDED = re.compile(r'src="data:image/(webp|jpeg);base64,([^"]+)"(?: data-ink)?')


class Live(NamedTuple):
    """A widget as its page needs it: name of its files, script, style, state, and its picture.

    In the state bytes are {"base64": text}; the first of many pictures is {"shown": true}: the page
    has it.
    """

    name: str
    script: str
    style: str
    state: dict[str, Any]
    picture: bytes  # none where a question is answered without one
    alt: str

    @property
    def code(self) -> str:
        """Name of the file of its script and style."""
        return f"code-{hashlib.sha256((self.script + self.style).encode()).hexdigest()[:16]}"

    def as_html(self, folder: str) -> str:
        """Return what stands on the page, where `folder` is the address of the files."""
        still = f"<p>{escape(self.alt)}</p>"
        if self.picture:
            source = f'src="{folder}/{self.name}.webp"'
            still = f'<img {source} alt="{escape(self.alt)}" {_look(self.picture)} loading="lazy">'
        scripts = f'data-code="{folder}/{self.code}.js" data-from="{folder}/{self.name}.js"'
        return f'<div class="live" data-name="{self.name}" {scripts}>{still}</div>'


def widgets(notebook: Any, name: str) -> Iterator[tuple[Any, Live]]:
    """Yield each output of an executed notebook that shows a widget of ours, and the widget."""
    models = notebook.metadata.get("widgets", {}).get(STATE, {}).get("state", {})
    shown = (output for output in _outputs(notebook) if VIEW in output.get("data", {}))
    for number, output in enumerate(shown):
        model = models.get(output["data"][VIEW]["model_id"])
        if model is not None and "_esm" in model["state"]:
            yield output, live(model, f"{name}-{number + 1}")


def live(model: Any, name: str) -> Live:
    """Return a widget from a notebook's record of it."""
    record = json.loads(json.dumps(model))
    state = record["state"]
    for buffer in record.get("buffers", []):
        *path, last = buffer["path"]
        place = state
        for step in path:
            place = place[step]
        place[last] = {"base64": buffer["data"]}
    own = {
        key: value for key, value in state.items() if not (key.startswith("_") or key in NOT_OWN)
    }
    # a question has none
    shown = next((own[key] for key in PICTURES if own.get(key)), {"base64": ""})
    shown = shown[0] if isinstance(shown, list) else shown
    alt = own.get("question") or (own["alts"][0] if "alts" in own else own["alt"])
    picture = base64.b64decode(shown["base64"])
    if "scales" in own:  # of pictures that are compared: they have no loss
        picture = encode_change(web.decode_picture(picture))
        own["pictures"] = [{"base64": _lighter(each["base64"])} for each in own["pictures"]]
    for many in {"stored", "frames"} & own.keys():
        own[many] = [{"shown": True}, *own[many][1:]]
    return Live(name, state["_esm"], state.get("_css", ""), own, picture, alt)


def _lighter(exact: str) -> str:
    """Return a picture without loss in fewer bytes, where it is like a photograph."""
    picture = base64.b64decode(exact)
    lossy = web.encode_jpeg(web.decode_picture(picture), quality=95)
    return base64.b64encode(min(picture, lossy, key=len)).decode()


def _look(picture: bytes) -> str:
    """Return a picture's size as its element has it, and whether it is ink."""
    shown = web.decode_picture(picture)
    height, width, _ = shown.shape
    return f'width="{width}" height="{height}"{" data-ink" * is_ink(shown)}'


def set_apart(notebook: Any, name: str, folder: Path, address: str) -> None:
    """Put the pictures that stand in an executed notebook's HTML into files, fetched as they come into view.

    `address` is that of the folder, from the page.
    """
    number = count(1)

    def moved(embedded: re.Match[str]) -> str:
        picture = base64.b64decode(embedded[2])
        file = f"{name}-p{next(number)}.{embedded[1]}"
        write_changed(folder / file, picture)
        return f'src="{address}/{file}" {_look(picture)} loading="lazy"'

    for data in [
        output["data"] for output in _outputs(notebook) if "text/html" in output.get("data", {})
    ]:
        data["text/html"] = EMBEDDED.sub(moved, "".join(data["text/html"]))


def write(one: Live, folder: Path) -> None:
    """Write the files of a widget; what stands there as it should is left alone."""
    code = json.dumps({"script": one.script, "style": one.style})
    write_changed(folder / f"{one.code}.js", f'hdrlab.take("{one.code}", {code});\n'.encode())
    own = BYTES.sub(_packed, json.dumps({"code": one.code, "state": one.state}))
    write_changed(
        folder / f"{one.name}.js", f'hdrlab.take("{one.name}", {own});\n'.encode("utf-16")
    )
    if one.picture:
        write_changed(folder / f"{one.name}.webp", one.picture)


def _packed(found: re.Match[str]) -> str:
    data = base64.b64decode(found[1])
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    words = np.pad(bits, (0, -len(bits) % LETTER)).reshape(-1, LETTER) @ (
        1 << np.arange(LETTER)[::-1]
    )
    letters = (words + FIRST).astype("<u2").tobytes().decode("utf-16-le")
    return f'{{"letters": "{letters}", "length": {len(data)}}}'


def write_changed(path: Path, content: bytes) -> None:
    """Write a file, unless it holds just this: so its time tells whether a page must be made again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_bytes() != content:
        files.write(path, content)


def _outputs(notebook: Any) -> Iterator[Any]:
    for cell in notebook.cells:
        yield from cell.get("outputs", [])
