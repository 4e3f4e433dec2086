"""Show an HDR image file in a notebook, for screens that are brighter than white."""

from dataclasses import dataclass
from pathlib import Path

from hdrlab.io import web
from hdrlab.show.pages.templates import templates
from hdrlab.show.pictures import require_alt


@dataclass(frozen=True)
class Lit:
    """An HDR image (.jpg, .png or .avif) with a switch that limits it to white.

    The browser decodes the file itself. A note beside the switch tells whether the reader's screen
    can show more light than white.

    Attributes
    ----------
    path : the file
    alt : what the image shows, in one sentence
    """

    path: Path
    alt: str

    def __repr__(self) -> str:
        return self.alt

    def _repr_html_(self) -> str:
        image_type = self.path.suffix[1:].lower().replace("jpg", "jpeg")
        src = web.data_uri(self.path.read_bytes(), image_type)
        page = templates(Path(__file__).parent).get_template("lit.html")
        return page.render(src=src, alt=require_alt(self.alt))
