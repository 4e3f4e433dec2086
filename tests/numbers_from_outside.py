"""Numbers in the answers of notebooks that no cell computes, by page, each with where it comes from.

A number of one digit, and one that is written as a word, stands with its unit.
"""

PAPERS_PROGRAM = "the entry of level 128 in the program of Debevec and Malik, counted from 1"

NUMBERS = {
    "04": {
        "half a level": "the lower end of level 1, which holds all that is rounded to it",
        "129": PAPERS_PROGRAM,
        "50": "the samples that Debevec and Malik used",
    },
    "07": {
        "4.018": "the estimate of a ratio of 4 that the paper reports",
        "0 stops": "where the slider begins",
        "six stops": "where the slider ends",
    },
    "08": {
        "2.8": "percent, the paper's example of a motion that is not linear",
        "0 %": "an error that no photo reaches",
        "1 %": "the difference that the paper's good example stays below",
    },
    "09": {"254": "second differences of 256 levels"},
    "10": {"eight times": "a burst of eight frames"},
    "11": {
        "two degrees": "an example of a rotation",
    },
    "13": {
        "76": "decades between the exponents 1 and 255 of RGBE",
        "146": "an example of a mantissa",
        "23": "bits of the mantissa of IEEE 754 single precision",
    },
    "14": {
        "2.5": "percent of the sum, in the paper and in the program `pcond`",
        "15": "pixels, the width of the blur in Battiato and others, 2008",
        "1.6": "percent of the image's width, read off their figure",
        "8 %": "of the longer side, the default width of the library",
        "two levels": "the lowest and the highest one",
        "50": "half of the ratio 1 : 100, see 50.5",
    },
    "15": {"2 %": "of the image's size, the paper's width of the filter"},
    "19": {"half a level": "the upper end of level 0, which holds all that is rounded to it"},
    "20": {"8 bits": "an example of a file"},
    "21": {"four percent": "an error of the speed in the figure"},
    "22": {
        "129": PAPERS_PROGRAM,
        "50": "an example of a number of samples",
        "50 000": "an example of a number of samples",
    },
}
