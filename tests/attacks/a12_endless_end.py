"""Return an object that never finishes when it is deleted."""


class Clinging:
    def __del__(self):
        while True:
            pass


def double(x):
    Clinging()
    return 2 * x
