"""The tables of FRAMES.md, "Residuals": the probability of each residual by scale and position."""

STEEPNESS = (
    5689, 4784, 4023, 3383, 2844, 2392, 2011, 1691, 1422, 1196, 1006, 846,
    711, 598, 503, 423, 356, 299, 251, 211, 178, 149, 126, 106,
)
RADIUS = (2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 5, 6, 7, 7, 9, 10, 12, 13, 16, 18)
LOGISTIC = (
    32768, 34813, 36843, 38841, 40793, 42687, 44511, 46254, 47911, 49474, 50941, 52310,
    53581, 54754, 55834, 56822, 57724, 58544, 59287, 59959, 60565, 61109, 61598, 62036,
    62428, 62778, 63090, 63368, 63615, 63835, 64030, 64203, 64357, 64494, 64614, 64721,
    64816, 64900, 64974, 65039, 65097, 65149, 65194, 65234, 65269, 65300, 65328, 65352,
    65374, 65393, 65410, 65425, 65438, 65449, 65459, 65468, 65476, 65483, 65489, 65495,
    65500, 65504, 65508, 65511, 65514, 65517, 65519, 65521, 65523, 65524, 65526, 65527,
    65528, 65529, 65530, 65530, 65531, 65532, 65532, 65533, 65533, 65533,
)
LARGEST_CLASS = 67


def part_below(x: int, steepness: int) -> int:
    """Returns P(x): the part of the distribution below x eighths, in 65536ths."""
    u = abs(x) * steepness
    i = min(u >> 8, 80)
    p = LOGISTIC[i] + (((LOGISTIC[i + 1] - LOGISTIC[i]) * (u % 256)) >> 8)
    return 65536 - p if x < 0 else p


def starts_of(table: int, place: int) -> list[int]:
    """Returns the start of each symbol of a table, and 4096 after the last."""
    steepness, radius = STEEPNESS[table], RADIUS[table]
    m = 3 if place == 1 else 1
    n = 2 * radius + 2
    below_all = part_below(-8 * radius - 4 - m, steepness)
    starts = [
        k + (part_below(8 * (k - radius) - 4 - m, steepness) - below_all) * (4096 - n) // 65536
        for k in range(n)
    ]
    return starts + [4096]


STARTS = tuple(tuple(starts_of(table, place) for place in (0, 1)) for table in range(24))


def table_of(residual_class: int) -> tuple[int, int]:
    """Returns the table of a class, and its number of low bits."""
    if residual_class < 24:
        return residual_class, 0
    d = residual_class - 24
    return 20 + d % 4, 1 + d // 4


def class_of_size(size: int) -> int:
    """Returns C(z) of a mean absolute residual in 2048ths."""
    z = max(size, 64)
    n = z.bit_length() - 7
    return 4 * n + ((z >> (n + 4)) % 4) - 3
