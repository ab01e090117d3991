"""The Radar Warner's CSP Bayesian in Python, as examples/reconnaissance/threats/emitter_classification.hpp says: bayesian.py FOLDER DOMAIN VENDOR.

The IDL compiler has written the types into the folder."""

import math
import sys

import skein

folder, domain, vendor = sys.argv[1:]
sys.path.append(folder)
from threats_idl import recon

Mode = recon.RadarMode
# type, mode, intervals of frequency, pulse interval and scan, prior
LIBRARY = [
    ("short-range site", Mode.Search, (2.9e9, 3.1e9), (0.8e-3, 1.2e-3), (3.5, 4.5), 3),
    ("short-range site", Mode.Track, (8.6e9, 9.0e9), (180e-6, 220e-6), (0, 0), 2),
    ("short-range site", Mode.Guidance, (8.9e9, 9.2e9), (45e-6, 60e-6), (0, 0), 1),
    ("medium-range site", Mode.Search, (3.0e9, 3.3e9), (1.1e-3, 1.6e-3), (4, 6), 3),
    ("medium-range site", Mode.Track, (8.8e9, 9.4e9), (200e-6, 260e-6), (0, 0), 2),
    ("medium-range site", Mode.Guidance, (9.1e9, 9.6e9), (55e-6, 75e-6), (0, 0), 1),
    ("mobile gun", Mode.Search, (14.0e9, 15.0e9), (90e-6, 130e-6), (1.5, 2.5), 2),
    ("mobile gun", Mode.Track, (14.5e9, 15.5e9), (80e-6, 110e-6), (0, 0), 1),
    ("coast radar", Mode.Search, (3.0e9, 3.1e9), (1.0e-3, 1.3e-3), (2.5, 3.8), 1),
    ("air surveillance", Mode.Search, (1.25e9, 1.35e9), (2.5e-3, 4e-3), (9, 12), 2),
    ("air surveillance", Mode.Track, (3.1e9, 3.4e9), (1.5e-3, 2.2e-3), (5, 8), 1),
]
UNKNOWN = ("", Mode.Off, (0.5e9, 40e9), (1e-6, 1e-2), (0, 20), 0)
UNKNOWN_PRIOR = 0.01


def density(value, sigma, interval):
    """Of a value uniform in an interval with a normal error."""
    least, greatest = interval
    if greatest - least > 1e-6 * sigma:
        below, above = (0.5 * math.erfc((bound - value) / (sigma * math.sqrt(2))) for bound in interval)
        return (below - above) / (greatest - least)
    return math.exp(-0.5 * ((value - least) / sigma) ** 2) / (sigma * math.sqrt(2 * math.pi))


class Bayesian(recon.IEmitterClassifier):
    identified = 0

    def classify(self, train):
        if not train.intercepts:
            raise recon.NotSure("nothing was received")
        last = train.intercepts[-1]
        measured = [(last.frequency_hz, 20e6), (last.pulse_interval_s, 0.02 * last.pulse_interval_s), (last.scan_s, 0.2)]
        priors = sum(each[5] for each in LIBRARY)
        best, total = recon.Identification(), 0.0
        for emitter, mode, *intervals, prior in [*LIBRARY, UNKNOWN]:
            share = (1 - UNKNOWN_PRIOR) * prior / priors if emitter else UNKNOWN_PRIOR
            probability = share * math.prod(density(value, sigma, interval) for (value, sigma), interval in zip(measured, intervals))
            total += probability
            if probability > best.confidence:
                best = recon.Identification(emitter, mode, probability)
        if not total > 0:
            return recon.Identification("", Mode.Off, 1)
        best.confidence /= total
        self.identified += 1
        if self.identified == 1:
            print("Bayesian identifies in Python", flush=True)
        return best


with skein.Entity("bayesian", system="uav-1", vendor=vendor, domain=int(domain)) as own:
    own.provide(Bayesian(), csp="Bayesian", owner="uav-1/radar_warner", attributes={"latency": "1 ms", "quality": "0.8"})
    skein.ready()
    skein.wait()
