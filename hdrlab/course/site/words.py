r"""What the site's search takes for a word: beside words, a letter of a formula and a function of a letter.

In a formula stands \lambda, in a text the letter itself, and in code a lambda that means something
else.
"""

import re
from pathlib import Path

from sphinx.search.en import SearchEnglish

GREEK = {
    "α": "alpha",
    "β": "beta",
    "γ": "gamma",
    "λ": "lambda",
    "μ": "mu",
    "σ": "sigma",
    "τ": "tau",
}
CODE = re.compile(r"\blambda\b[\w ,*=.]*:")  # Python's own
CALL = re.compile(r"\b([A-Za-z])\(([A-Za-z])(?:_\{?\w+\}?)?\)")  # g(Z), and of one pixel g(Z_{ij})
SPLIT = Path(__file__).with_name("split_query.js")  # the same in the browser


class Words(SearchEnglish):
    """English, g(Z) and λ."""

    js_splitter_code = f"const greek = {GREEK};\n{SPLIT.read_text('utf8')}"

    def split(self, text: str) -> list[str]:
        """Return the words of a text; a function of a letter is one word, beside its two letters."""
        plain = re.sub(
            "[α-ω]", lambda found: f" {GREEK.get(found[0], found[0])} ", CODE.sub(" ", text)
        )
        return super().split(plain) + [f"{f}({x})".lower() for f, x in CALL.findall(text)]
