"""What `skein new` begins is built, checked and flown with an installed package: new_components.py PREFIX FOLDER [CMake's arguments].

FOLDER is made anew.
"""

import os
import shutil
import subprocess
import sys

prefix, folder, *options = sys.argv[1:]
skein = os.path.join(prefix, "bin", "skein")
environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "SKEIN_MODULE_PATH": os.path.join(folder, "build")}


def run(*command, code=0):
    """What the command says. Ends this program if it ends with another exit code."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder, env=environment, timeout=300)
    if done.returncode != code:
        sys.exit(f"{' '.join(command)} ended with {done.returncode} and said:\n{done.stdout}")
    return done.stdout


shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
run(skein, "new", "entity", "Lookout")
run(skein, "new", "csp", "Spiral", "--implements", "IPlanner")
run(skein, "new", "entity", "Helm", "--needs", "ILookout", "--csps", "AE_navigator::IPlanner",
    "--operations", "struct Course { double degrees; };\nvoid steer(in Course to);\nCourse course();\n@stream Course courses();")  # fmt: skip
run(skein, "new", "activity", "Watch", "--needs", "helm::IHelm")
with open(os.path.join(folder, "chart.idl"), "w", encoding="utf-8") as chart:
    chart.write('#include "lookout/lookout.idl"\ninterface IChart { double Test(); };\n')
run(skein, "new", "entity", "Test", "--implements", "IChart")
run(skein, "new", "entity", "Pilot", "--needs", "IChart", "--needs", "lookout::ILookout", "--operations", "void Pilot()")
shutil.rmtree(os.path.join(folder, "lookout"))
run(skein, "new", "entity", "Lookout")
run("cmake", "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={prefix}", *options)
run("cmake", "--build", "build", "--parallel", "2")
run(skein, "check", "lookout/mission.xml")
with open(os.path.join(folder, "together.xml"), "w", encoding="utf-8") as mission:
    mission.write("""<mission name="together" domain="57" system="boat">
  <peer name="lookout" component="lookout/lookout.xml" plugin="lookout"/>
  <peer name="helm" component="helm/helm.xml" plugin="helm"><csp component="spiral/spiral.xml" plugin="spiral"/></peer>
  <peer name="watch" component="watch/watch.xml" plugin="watch"/>
</mission>
""")
launcher = subprocess.Popen([skein, "launch", "--no-log", "together.xml"], cwd=folder, env=environment)
try:
    told = run(skein, "call", "IHelm", "course", "--domain", "57", code=69)
    if "Helm: course is not written yet" not in told:
        sys.exit(f"the helm said {told!r}")
finally:
    launcher.terminate()
    launcher.wait(30)
