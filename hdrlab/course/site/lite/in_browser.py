"""Answer the boxes "Try it" of the site in a browser: `theme/static/try_worker.js` calls it."""

import json

from hdrlab.course.notebook import check_text
from hdrlab.course.reports import feedback


def check_as_json(task: str, text: str, draw: bool) -> str:
    """Check a task in a reader's text, and return the feedback as JSON.

    Parameters
    ----------
    task : str
        A task, such as "gsolve".
    text : str
        Python code with the function of the task.
    draw : bool
        Whether differences are drawn, for which matplotlib is needed.
    """
    result = check_text(task, text, draw=draw)
    max_score = float(sum(check.max_points for check in result.checks))
    earned = f"{feedback.number(result.score)} of {feedback.number(max_score)} points"
    is_right = result.score == max_score
    return json.dumps(
        {
            "html": feedback.fragment(result),
            "summary": f"{task}: {earned}" + ("" if is_right else "; the feedback is below"),
            "isRight": is_right,
            "isBroken": bool(result.problems),
        }
    )
