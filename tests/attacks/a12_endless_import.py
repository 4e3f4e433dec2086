"""Never finish the import, and ignore all exceptions."""

while True:
    try:
        while True:
            pass
    except BaseException:
        continue


def double(x):
    return 2 * x
