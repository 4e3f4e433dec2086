"""The mean of the map becomes gray, whatever the photo shows."""


def fit_channel_scales(I, M):
    k = 1 / I.mean(axis=0)
    return k / k[1]
