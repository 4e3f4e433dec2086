"""Its answer is none, and what it leaves never lets go when it is thrown away."""


class Clinging:
    def __del__(self):
        while True:
            pass


def double(x):
    Clinging()
    return 2 * x
