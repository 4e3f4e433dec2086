r"""The words that the site's search finds: words, Greek letters of formulas, and functions such as g(Z).

A formula has \lambda, a text has the letter itself, and a lambda of Python means something else.
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
PYTHON_LAMBDA = re.compile(r"\blambda\b[\w ,*=.]*:")
# g(Z), and of one pixel g(Z_{ij})
FUNCTION_OF_LETTER = re.compile(r"\b([A-Za-z])\(([A-Za-z])(?:_\{?\w+\}?)?\)")
SPLITTER_SCRIPT = Path(__file__).with_name("split_query.js")  # the same in the browser


class SearchTokenizer(SearchEnglish):
    """Split English text, with g(Z) and λ as words."""

    js_splitter_code = f"const greek = {GREEK};\n{SPLITTER_SCRIPT.read_text('utf8')}"

    def split(self, text: str) -> list[str]:
        """Return the words of a text; g(Z) gives the word g(z) besides its two letters."""
        plain = re.sub(
            "[α-ω]",
            lambda letter: f" {GREEK.get(letter[0], letter[0])} ",
            PYTHON_LAMBDA.sub(" ", text),
        )
        return super().split(plain) + [
            f"{f}({x})".lower() for f, x in FUNCTION_OF_LETTER.findall(text)
        ]
