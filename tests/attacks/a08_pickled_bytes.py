"""Return the bytes of a pickle, and of a numpy file that contains a pickle."""

import io
import pickle

import numpy as np

PLACE = ""


class Pickled:
    def __reduce__(self):
        return eval, (f"open({PLACE + '/unpickled'!r}, 'w').write('x')",)


def double(x):
    file = io.BytesIO()
    np.save(file, np.array([Pickled()], dtype=object), allow_pickle=True)
    return file.getvalue() + pickle.dumps(Pickled())
