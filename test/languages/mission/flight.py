"""The reconnaissance mission with the Radar Warner's CSPs in Java, Python and Ada, on both vendors: flight.py ROOT BUILD. It flies as with those in C++: the
same verdict and tracks. Then once more, while each of them is restarted by `skein restart`."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT, BUILD = sys.argv[1:]
HERE = os.path.dirname(os.path.abspath(__file__))
SKEIN = os.path.join(BUILD, "bin", "skein")
IDL = os.path.join(ROOT, "examples", "reconnaissance", "idl")
CSPS = {"TableMatch": "Java", "Bayesian": "Python", "Wideband": "Ada"}
# One target near the runway, and an intruder that comes soon.
SHORT = ["elements=shed 1 5 0.3 20 53.3089 27.3225", "objects=53.3089 27.3226 3 0 0", "intruders=270 30 7000 60", "failures=2 wrong 40 300",
         "planner_failures=2 killed"]  # fmt: skip


def compiled(folder):
    """{CSP: (program, arguments)}"""
    for language in ("java", "ada", "python"):
        files = [os.path.join(IDL, name) for name in ("threats.idl", "place.idl")]
        subprocess.run(["/usr/bin/python3", "-B", os.path.join(ROOT, "idl", "compiler"), "--language", language, "--out", folder, *files], check=True)
    jars = f"{os.environ['SKEIN_JNA']}:{BUILD}/share/java/skein.jar:{folder}/classes"
    sources = [os.path.join(folder, "recon", each) for each in os.listdir(os.path.join(folder, "recon"))]
    subprocess.run(["javac", "-cp", jars, "-d", f"{folder}/classes", os.path.join(HERE, "TableMatch.java"), *sources], check=True)
    subprocess.run(["gnatmake", "-q", "-D", folder, f"-aI{folder}", f"-aI{HERE}", f"-aI{ROOT}/src/languages/ada", "-aO" + os.environ["SKEIN_ADA_OBJECTS"],
                    os.path.join(HERE, "wideband.adb"), "-o", f"{folder}/wideband", "-largs", *os.environ["SKEIN_LINK"].split()], check=True)  # fmt: skip
    return {"TableMatch": ("java", ["-Xshare:auto", "-cp", jars, "TableMatch"]), "Bayesian": ("/usr/bin/python3", ["-B", os.path.join(HERE, "bayesian.py"), folder]),
            "Wideband": (f"{folder}/wideband", [])}  # fmt: skip


def changed(mission, programs):
    """The mission's text with programs as the warner's CSPs."""
    for number, (name, (program, arguments)) in enumerate(programs.items()):
        file = "components/" + re.sub("(?<=.)([A-Z])", r"_\1", name).lower() + ".xml"
        given = "".join(f'<argument value="{each}"/>' for each in [*arguments, "${domain}", f"${{vendor_{'ab'[number % 2]}}}"])
        own = f'<csp component="{file}" process="own" program="{program}" ready="told" restart="on-failure">{given}</csp>'
        before = f'<csp component="{file}" process="in" thread="caller"/>'
        assert mission.count(before) == 1, name
        mission = mission.replace(before, own)
    return mission


def fly(profile, folder, meanwhile=lambda mission: ""):
    """What its processes print, the report of the flight, and the tracks of all that flew."""
    os.makedirs(folder)
    command = [SKEIN, "launch", "--no-log", *(word for each in SHORT for word in ("--variable", each)), profile]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as mission:
        told = meanwhile(mission) + mission.communicate(timeout=300)[0]
    if mission.returncode != 0:
        sys.exit(f"{profile} ended with {mission.returncode}: {told}")
    with open(os.path.join(folder, "reconnaissance.json"), encoding="utf-8") as report, open(os.path.join(folder, "reconnaissance.csv"), encoding="utf-8") as tracks:
        return told, json.load(report), tracks.read()


def restart_each(profile):
    def begun(mission):
        """Each is stopped and started anew, in flight."""
        told = ""
        while "TakeOff" not in told:
            told += mission.stdout.readline()
        for name in (f"radar_warner/{csp}" for csp in CSPS):
            before = state(profile, name)["pid"]
            subprocess.run([SKEIN, "restart", profile, name], check=True, stdout=subprocess.DEVNULL)
            while (now := state(profile, name))["pid"] == before or now["state"] != "ready":
                time.sleep(0.02)
        return told

    return begun


def state(profile, process):
    told = subprocess.run([SKEIN, "status", "--json", profile], check=True, stdout=subprocess.PIPE, text=True).stdout
    return next(each for each in json.loads(told)["processes"] if each["name"] == process)


def have_identified(told, times):
    """Whether each CSP has, in so many processes at least."""
    counts = {csp: told.count(f"{csp} identifies in {language}") for csp, language in CSPS.items()}
    print(f"processes that have identified: {counts}")
    return all(count >= times for count in counts.values())


def main():
    with tempfile.TemporaryDirectory() as folder:
        profiles = os.path.join(folder, "mission_profiles")
        shutil.copytree(os.path.join(ROOT, "mission_profiles"), profiles)
        own = os.path.join(profiles, "reconnaissance", "reconnaissance.xml")
        mixed = os.path.join(profiles, "reconnaissance", "languages.xml")
        with open(own, encoding="utf-8") as cpp, open(mixed, "w", encoding="utf-8") as other:
            other.write(changed(cpp.read(), compiled(os.path.join(folder, "made"))))
        _, report, tracks = fly(own, os.path.join(folder, "cpp"))
        told, other_report, other_tracks = fly(mixed, os.path.join(folder, "mixed"))
        same = [part for part in ("verdict", "checks", "targets", "threats", "phases", "routes") if report[part] == other_report[part]]
        print(f"the same in both flights: {', '.join(same)}; tracks: {tracks == other_tracks}")
        told_again, restarted, _ = fly(mixed, os.path.join(folder, "restarted"), restart_each(mixed))
        print(f"with restarts: {restarted['verdict']}")
        right = len(same) == 6 and tracks == other_tracks and restarted["verdict"] == "passed"
        return 0 if right and have_identified(told, 1) and have_identified(told_again, 2) else 1


sys.exit(main())
