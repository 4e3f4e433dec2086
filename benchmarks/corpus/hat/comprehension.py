def hat(n=256):
    return [z if z <= 0.5 * (n - 1) else n - 1 - z for z in range(n)]
