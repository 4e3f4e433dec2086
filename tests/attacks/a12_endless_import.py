"""It is never imported to its end, and takes no error for an end."""

while True:
    try:
        while True:
            pass
    except BaseException:
        continue


def double(x):
    return 2 * x
