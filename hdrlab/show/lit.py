"""A picture for HDR screens in a notebook and on its page, beside ordinary ones."""

from pathlib import Path
from typing import NamedTuple

from hdrlab.io import web
from hdrlab.show.pages.templates import templates
from hdrlab.show.pictures import require_alt


class Lit(NamedTuple):
    """A file that lights up, .jpg, .png or .avif, with a switch that holds it at white.

    A browser reads such a file itself, so it is shown as it is. Beside the switch stands whether
    the reader's screen has more light than white.

    Attributes
    ----------
    path : the file
    alt : what it shows, in a sentence
    """

    path: Path
    alt: str

    def __repr__(self) -> str:
        return self.alt

    def _repr_html_(self) -> str:
        src = web.data_uri(
            self.path.read_bytes(), self.path.suffix[1:].lower().replace("jpg", "jpeg")
        )
        page = templates(Path(__file__).parent).get_template("lit.html")
        return page.render(src=src, alt=require_alt(self.alt))
