# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: browser.py FOLDER

Opens the pages of the site in FOLDER from the file system, at the widths of a phone and of a desktop, in
chromium without a window. Formulas must be set and pictures shown, and nothing may be wider than its
page. Without chromium it checks nothing.
"""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

WIDTHS = (390, 1280)  # pixels, of a common phone and a small desktop
SECONDS = 170
# Opens one page after the other in a frame. What scrolls within the page may be wider than it, and what furo
# sets beside the text, such as links of headings, by a few pixels.
LOOK = """<!DOCTYPE html><pre id="faults"></pre><script>
const faults = [];
function look(page, view) {
  const tree = view.document, all = list => [...list];
  const say = (what, part) => faults.push(page + ": " + what + " '" + part.trim().slice(0, 60) + "'");
  const unset = all(tree.querySelectorAll(".math")).filter(part => !part.querySelector(".katex"));
  unset.forEach(part => say("formula is not set", part.textContent));
  all(tree.querySelectorAll(".katex-error")).forEach(part => say("formula is wrong", part.textContent));
  all(tree.images).filter(one => one.complete && !one.naturalWidth)
    .forEach(one => say("no picture", one.src));
  const article = tree.querySelector("article");
  if (!article) return;
  const end = article.getBoundingClientRect().right + 10;
  const scrolls = part => part !== article &&
    (view.getComputedStyle(part).overflowX !== "visible" || scrolls(part.parentElement));
  const wide = all(article.querySelectorAll("*")).find(
    part => part.getBoundingClientRect().right > end && !scrolls(part));
  if (wide) say("wider than the page", wide.textContent);
}
async function open(page) {
  const frame = document.createElement("iframe");
  frame.style = "border: 0; height: 900px; width: WIDTHpx";
  const loaded = new Promise(done => frame.onload = done);
  frame.src = "FOLDER/" + page;
  document.body.append(frame);
  await loaded;
  await new Promise(done => setTimeout(done, 100));
  look(page, frame.contentWindow);
  frame.remove();
}
onload = async () => {
  for (const page of PAGES) await open(page);
  document.getElementById("faults").textContent = JSON.stringify(faults);
};
</script>"""


def faults_of(folder: Path, pages: list[str], width: int, chromium: str) -> list[str]:
    """Returns what is wrong on pages at a width [pixels]."""
    text = (
        LOOK.replace("WIDTH", str(width))
        .replace("FOLDER", folder.as_uri())
        .replace("PAGES", json.dumps(pages))
    )
    with tempfile.TemporaryDirectory() as scratch:
        (Path(scratch) / "look.html").write_text(text, encoding="utf-8")
        shown = subprocess.run(
            [
                chromium,
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--allow-file-access-from-files",
                f"--user-data-dir={scratch}/profile",
                "--virtual-time-budget=1000000",
                "--dump-dom",
                (Path(scratch) / "look.html").as_uri(),
            ],
            capture_output=True,
            text=True,
            timeout=SECONDS,
            check=False,
        ).stdout
    found = re.search(r'<pre id="faults">(\[.*?\])</pre>', shown, re.DOTALL)
    if not found:
        raise SystemExit("browser.py: chromium did not come to the end of the pages")
    return list(json.loads(html.unescape(found[1])))


def main() -> int:
    """Returns the exit code."""
    folder = Path(sys.argv[1]).resolve()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        print("No chromium: pages are not looked at")
        return 0
    paths = (path.relative_to(folder) for path in sorted(folder.rglob("*.html")))
    pages = [path.as_posix() for path in paths if path.parts[:2] != ("reference", "cpp")]
    n_faults = 0
    for width in WIDTHS:
        faults = faults_of(folder, pages, width, chromium)
        print("\n".join([*faults, f"{len(pages)} pages at {width} pixels, {len(faults)} faults"]))
        n_faults += len(faults)
    return 1 if n_faults else 0


if __name__ == "__main__":
    sys.exit(main())
