"""Never return."""


def double(x):
    while True:
        pass
