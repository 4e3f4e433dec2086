"""Numbers in the text of notebooks that no cell computes, by notebook, each with its origin.

A number with one digit, or written as a word, is listed with its unit.
"""

PAPERS_PROGRAM = "the entry of level 128 in the program of Debevec and Malik, counted from 1"

NUMBERS = {
    "03": {"two degrees": "an example of a rotation"},
    "04": {
        "half a level": "the lower end of level 1, which holds all that is rounded to it",
        "129": PAPERS_PROGRAM,
        "50": "the samples that Debevec and Malik used",
    },
    "05": {
        "100 000": "the logarithm of an error over that of the iteration's second largest eigenvalue"
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
    "10": {
        "eight times": "a burst of eight frames",
        "half a percent": "`MAX_RELATIVE_LOSS` in `pipeline.recovery`",
    },
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
        "8 %": "of the longer side, the default width of the library",
        "two levels": "the lowest and the highest one",
        "50": "half of the ratio 1 : 100, see 50.5",
    },
    "15": {"2 %": "of the image's size, the paper's width of the filter"},
    "18": {
        "three stops": "0.4 times the level at the edge, as light",
        "6.5": "stops, the upper end of AgX",
        "0.3": "N of `curves` on the street, 128 x 192: see test_quality.py",
    },
    "19": {"half a level": "the upper end of level 0, which holds all that is rounded to it"},
    "20": {"8 bits": "an example of a file"},
    "21": {"four percent": "an error of the speed in the figure"},
    "22": {
        "129": PAPERS_PROGRAM,
        "50": "an example of a number of samples",
        "50 000": "an example of a number of samples",
    },
}

# Numbers outside of answers that no cell computes and that are in no sentence of test_sentences.py.
OPEN_TEXT = {
    "00": {
        "100": "an example of a level",
        "128": "the level at which every g of hdrlab is 0",
        "200": "twice that level",
        "ten stops": "a screen of 1 : 1000; seven stops are 1 : 128",
    },
    "01": {
        "8 cd/m²": "the unit that own photos get, 8.0 in the code",
        "1 cd/m²": "the first rung of the ladder",
        "twelve decades": "from 1e-6 to 1e6 cd/m²",
        "four decades": "what an eye sees at once, a textbook figure; the figure's SPANS draw it",
        "seven decades": "from 1e-3 to more than 1e4 cd/m²",
        "a third of a stop": "a step of the shutter dial",
        "1 s": "a time of the slider",
        "two stops": "gained by a second gain, a makers' figure",
    },
    "02": {
        "20 000": "electrons, the full well of the simulated camera",
    },
    "03": {
        "four times": "two photos two stops apart",
        "8 pixels": "the period of the tiles",
        "41": "offsets from -20 to 20",
        "five times": "the six levels of the pyramid",
        "six levels": "the default of `align`",
        "two bits": "those that XOR compares",
        "64": "bits of a machine word",
        "84": "percent, reported by Ward (2003)",
        "3 %": "reported by Ward (2003)",
    },
    "04": {
        "four times": "two stops",
        "a quarter of a stop": "the default limit of the figure",
        "201": "curves of Grossberg and Nayar",
    },
    "05": {
        "252": "an example of a level",
        "254": "the level below white",
        "0.98": "the limit of Cerman and Hlavac",
    },
    "06": {
        "5 %": "a value of the slider",
        "50": "percent, a value of the slider",
        "2.2": "the exponent of the camera `gamma`",
        "0.45": "a limit of the ratios in the paper",
        "2.7": "percent, reported by the paper",
        "0 %": "a value of the slider",
    },
    "07": {"2.2": "the exponent of the camera `gamma`"},
    "09": {"1024": "points of the published curves (EMoR)"},
    "10": {
        "8 bits": "the depth of the simulated photos",
        "204": "0.8 of 255",
        "6.4": "a section of the paper",
        "125": "an example of a reading",
        "seven times": "the longer frame of the bracket of two",
    },
    "11": {
        "2 %": "an example of a closer camera",
        "8 pixels": "the largest shift of the simulated hand",
        "2 degrees": "its largest rotation",
        "5 %": "a limit in `pipeline.alignment`",
        "0.3": "pixels, a limit in `pipeline.alignment`",
    },
    "12": {"five percent": "the scattered fraction of this page"},
    "13": {
        "0000": "bits",
        "0001": "bits",
        "0010": "bits",
        "0100": "bits",
        "1000": "bits",
        "5 bits": "the exponent of IEEE 754 half precision",
    },
    "14": {
        "2 pixels": "a value of the slider",
        "0.4": "decades, see the definition of `chiu.halo`",
        "80": "pixels, a value of the slider",
    },
    "15": {
        "3 decades": "a value of the slider, and the height of the edge",
        "6 pixels": "a value of the slider",
        "0.005": "half of the square of an amplitude of 0.1",
    },
    "16": {
        "seven stops": "from zone II to zone VIII",
        "90": "percent, what white paper reflects",
        "ten times": "an example of a bright pixel",
    },
    "18": {
        "four decades": "see the map of the chapel",
        "two decades": "a screen of 1 : 100",
        "0.04": "F90 of the specification of Khronos PBR Neutral",
        "0.08": "2 F90 of that specification, where the offset ends",
        "2.2": "the exponent of AgX's display codes",
        "5000": "mu of the logarithm of Kalantari and Ramamoorthi, 2017",
        "16.5": "stops, the range of AgX",
        "4 stops": "where the ramp of the lamp begins",
        "8 stops": "where it ends",
        "240": "degrees, the blue of the display by the definition of hue",
    },
    "19": {
        "two levels": "the smoothing of the paper",
        "5 stops": "a value of the slider",
        "8 bits": "the depth of the photo",
    },
    "20": {
        "40": "pixels, a value of the slider",
    },
    "22": {
        "four times": "a class of four levels is four times as wide as a level",
        "201": "curves of Grossberg and Nayar",
        "255": "the top level of 8 bits",
    },
    "25": {
        "1 %": "the smallest visible step at 1 cd/m², a textbook figure",
        "1 cd/m²": "the luminance of that step",
        "3 %": "the smallest visible step at 0.01 cd/m², a textbook figure",
        "8 bits": "the depth of a gain map",
        "2 %": "the threshold of the eye at 2 cd/m², DICOM PS3.14: see test_matching.py",
        "21496": "a standard",
        "22028": "a standard",
    },
    "27": {
        "1 pixel": "an example of a slow walker, and the last of the search radii",
        "four times": "the brightness of the figures, see draw",
        "seven times": "the time of the long photo of the bracket",
    },
}
