"""A button that asks questions one after another: each one may depend on what came before.

    def steps():
        yield predict.entry("What should hat(5)[0] give?", 0)
        yield "<p>Yours gives 0.5.</p>"

    Dialogue("Ask me", steps)

This needs a kernel: it computes the next step after each answer.
"""

from collections.abc import Callable, Iterator
from html import escape
from typing import Any

import ipywidgets

from hdrlab.errors import HdrlabError
from hdrlab.show.widgets.predict import Prediction

Steps = Iterator[Prediction | str]
# what is shown while Python computes the next step
WAITING = "<p>Running ...</p>"
# the size of a notebook's text, which ipywidgets would make smaller
TEXT_STYLE = {"font_size": "var(--jp-content-font-size1, 14px)"}


class Dialogue(ipywidgets.VBox):  # type: ignore[misc]  # ipywidgets has no types
    """A button, and below it the steps of a dialogue: questions, and what is said after each.

    Parameters
    ----------
    label : str
        The text of the button.
    start : function
        Returns the steps. A str is HTML, which is shown at once, with formulas between dollar signs.
        After a question, the steps go on when it is answered. An HdrlabError ends the dialogue with
        its message.
    about : str
        A sentence beside the button.
    """

    def __init__(self, label: str, start: Callable[[], Steps], *, about: str = "") -> None:
        self._label = label
        self._start = start
        self._steps: Steps = iter(())
        self.button = ipywidgets.Button(
            description=label, layout=ipywidgets.Layout(width="max-content")
        )
        self.button.on_click(lambda _: self.begin())
        self._head = ipywidgets.HBox(
            [self.button, ipywidgets.HTML(escape(about), style=TEXT_STYLE)],
            layout=ipywidgets.Layout(flex_flow="row wrap", align_items="center"),
        )
        super().__init__([self._head])

    @property
    def questions(self) -> list[Prediction]:
        """The questions that were asked since the dialogue began."""
        return [child for child in self.children if isinstance(child, Prediction)]

    @property
    def texts(self) -> list[str]:
        """What was said since the dialogue began, as HTML."""
        return [child.value for child in self.children if isinstance(child, ipywidgets.HTMLMath)]

    def begin(self) -> None:
        """Begin the dialogue, or begin it again."""
        self.button.description = "Begin again"
        self.children = (self._head,)
        self._steps = self._start()
        self._go_on()

    def _go_on(self) -> None:
        """Show the steps up to the next question."""
        shown: tuple[Any, ...] = self.children
        self.children = (*shown, _text(WAITING))
        try:
            for step in self._steps:
                if isinstance(step, Prediction):
                    step.observe(lambda _: self._go_on(), "done")
                    shown = (*shown, step)
                    break
                shown = (*shown, _text(step))
        except HdrlabError as error:
            shown = (*shown, _text(f"<p>{escape(str(error))}</p>"))
        finally:
            self.children = shown

    def _repr_mimebundle_(self, **kwargs: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        bundle = super()._repr_mimebundle_(**kwargs)
        text = f"{self._label}: run this cell again"
        return dict(bundle) | {"text/html": f"<p>{escape(text)}</p>", "text/plain": text}, {}


def _text(html: str) -> ipywidgets.HTMLMath:
    return ipywidgets.HTMLMath(html, style=TEXT_STYLE)
