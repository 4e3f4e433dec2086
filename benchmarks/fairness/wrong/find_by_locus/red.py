"""What has more red than anything else."""


def find_by_locus(Z):
    return (Z[..., 0] > Z[..., 1]) & (Z[..., 1] > Z[..., 2])
