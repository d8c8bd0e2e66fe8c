"""Makes a scratch environment that holds the peers, and runs the script again inside it."""

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

PACKAGES = ["mitsuba==3.9.1", "pyluxcore==2.11.2", "numpy"]
LLVM = "libllvm19"


def enter(folder):
    """Continues in the environment in `folder`, which is made if it is missing. Does not return unless already there."""
    folder = Path(folder).absolute()
    if Path(sys.prefix).absolute() == folder:
        return
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
    if subprocess.run([python, "-c", "import importlib.util as u, sys; "
                       "sys.exit(not all(map(u.find_spec, ('mitsuba', 'pyluxcore', 'numpy'))))"]).returncode:
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
    if not (folder / "llvm").exists():
        fetch_llvm(folder / "llvm")
    os.execv(python, [str(python), *sys.argv])


def fetch_llvm(folder):
    """Unpacks Debian's LLVM 19 into `folder` where there is apt: Mitsuba's llvm variants are twice as fast as scalar_rgb.

    Nothing is installed into the system. Without it, Mitsuba takes the system's LLVM, if it is one that it can use.
    """
    if not (shutil.which("apt-get") and shutil.which("dpkg-deb")):
        return
    folder.mkdir(parents=True, exist_ok=True)
    if subprocess.run(["apt-get", "download", LLVM], cwd=folder, capture_output=True).returncode:
        print(f"{LLVM} cannot be had: Mitsuba will use the system's LLVM, or none")
        return
    for package in folder.glob("*.deb"):
        subprocess.run(["dpkg-deb", "--extract", package, folder], check=True)
        package.unlink()
