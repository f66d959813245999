"""Messages written by Cyclone DDS: a second implementation of CDR, with both byte orders."""

import peers
import pytest

SEEDS = range(6)


@pytest.fixture(scope="module")
def cyclone(message_types_file):
    with peers.CyclonePeer(message_types_file) as peer:
        yield peer


def test_cyclone(known, cyclone, echo):
    for name in [entry["message"] for entry in known if "message" in entry]:
        for seed in SEEDS:
            data = cyclone.random(name, seed)
            ours = echo.again(name, "cdr", data)
            assert ours == data, f"{name} with seed {seed}"
            assert cyclone.again(name, ours) == data, f"{name} with seed {seed}"
            other_order = cyclone.random_big_endian(name, seed)
            assert other_order[:2] == b"\0\0"
            assert echo.again(name, "cdr", other_order) == data, f"{name} with seed {seed}"
