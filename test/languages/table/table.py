"""What each language does on each transport: table.py README.md LANGUAGE=COMMAND...

COMMAND takes VENDOR SHARED_MEMORY provide|check. It provides what buoy.idl declares, or checks a provider in another process, and says `call ok`. Each
language provides for each, over DDS on both vendors, and through shared memory. In the table that is printed a cell has a transport's mark if all its
runs were right. README has to have the same table.
"""

import itertools
import shlex
import subprocess
import sys

FEATURES = ("call", "provide", "asynchronous", "stream", "topics", "CSP", "cancel", "deadline")
# A transport: vendors of the provider and of the caller, and whether calls may go through shared memory.
TRANSPORTS = {"Fast DDS": ("fastdds", "fastdds", "no"), "Cyclone DDS": ("cyclonedds", "cyclonedds", "no"), "shared memory": ("fastdds", "cyclonedds", "yes")}
MARKS = {"Fast DDS": "F", "Cyclone DDS": "C", "shared memory": "M"}
LANGUAGES = 5  # of a machine with all that they need
HEADS = ("C++", "C", "Python")  # whose callers have a Head, which judges CSPs


def run(provider, checker, transport):
    """{feature: whether it was right}"""
    vendor, other, shared_memory = TRANSPORTS[transport]
    with subprocess.Popen([*provider, vendor, shared_memory, "provide"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as peer:
        try:
            if peer.stdout.readline() != "provides\n":
                return {}
            told = subprocess.run([*checker, other, shared_memory, "check"], stdout=subprocess.PIPE, text=True, timeout=120, check=False)
            return dict((feature, verdict == "ok") for feature, verdict in (line.split(" ", 1) for line in told.stdout.splitlines()))
        finally:
            peer.stdin.close()
            try:
                peer.wait(20)
            except subprocess.TimeoutExpired:
                peer.kill()


def judged(results):
    """{(feature, language): {transport: right}} of {(provider, checker, transport): {feature: right}}"""
    cells = {}
    for (provider, checker, transport), features in results.items():
        for feature in FEATURES:
            if feature == "provide":
                cells.setdefault((feature, provider), {}).setdefault(transport, []).append(bool(features) and all(features.values()))
            elif feature == "CSP":
                if checker in HEADS:
                    cells.setdefault((feature, provider), {}).setdefault(transport, []).append(features.get(feature, False))
            else:
                cells.setdefault((feature, checker), {}).setdefault(transport, []).append(features.get(feature, False))
    return cells


def table(languages, cells):
    lines = ["| | " + " | ".join(languages) + " |", "|---" * (len(languages) + 1) + "|"]
    for feature in FEATURES:
        shown = []
        for language in languages:
            right = [transport for transport, runs in cells.get((feature, language), {}).items() if all(runs)]
            shown.append(" ".join(MARKS[each] for each in right))
        lines.append(f"| {feature} | " + " | ".join(shown) + " |")
    return "\n".join(lines) + "\n"


def main():
    readme, *commands = sys.argv[1:]
    peers = {language: shlex.split(command) for language, command in (each.split("=", 1) for each in commands)}
    results = {}
    for provider, checker, transport in itertools.product(peers, peers, TRANSPORTS):
        results[provider, checker, transport] = run(peers[provider], peers[checker], transport)
        wrong = [feature for feature, right in results[provider, checker, transport].items() if not right]
        if wrong or not results[provider, checker, transport]:
            print(f"{checker} calls {provider} by {transport}: {', '.join(wrong) or 'nothing was told'}", file=sys.stderr)
    made = table(list(peers), judged(results))
    print(made)
    with open(readme, encoding="utf-8") as text:
        if len(peers) == LANGUAGES and made not in text.read():
            sys.exit(f"{readme} has another table")
    return 0 if all(features and all(features.values()) for features in results.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
