"""Return an object that runs code when it is unpickled."""

PLACE = ""


class Pickled:
    def __reduce__(self):
        return eval, (f"open({PLACE + '/unpickled'!r}, 'w').write('x') and 2 * x", {"x": 1})

    def __array__(self, *_, **__):
        raise TypeError("it is a pickle")


def double(x):
    return Pickled()
