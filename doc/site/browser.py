# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: browser.py FOLDER [--pictures FOLDER]

Opens the pages of the site in FOLDER from the file system, at the widths of a phone and of a desktop, in
chromium without a window. Formulas must be set and pictures shown, and nothing may be wider than its
page. The page of the search must find the words of search_terms.py. With --pictures it keeps pictures of six
pages at both widths, for people to look at. Without chromium it checks nothing, says so and returns 3.
"""

from __future__ import annotations

import argparse
import html
import itertools
import json
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from urllib.parse import quote

from search_terms import TERMS

WIDTHS = (390, 1280)  # pixels, of a common phone and a small desktop
SECONDS = 900  # of one look, on a machine that may be busy
LACKING = 3  # exit code
SHOWN = (
    "index.html",
    "start.html",
    "scenes/index.html",
    "theory/contact_tools.html",
    "reference/parameters/contact-pairs.html",
    "results/extremes.html",
)
HEIGHT = 1600  # of pictures, pixels
# Opens one page after the other in a frame, which then takes each width. What scrolls within the page may be
# wider than it, and what furo sets beside the text, such as links of headings, by a few pixels.
LOOK = """<!DOCTYPE html><pre id="found"></pre><script>
const widths = WIDTHS, found = widths.map(() => ({faults: [], formulas: 0}));
function look(page, view, here) {
  const tree = view.document, all = list => [...list];
  const say = (what, part) => here.faults.push(page + ": " + what + " '" + part.trim().slice(0, 60) + "'");
  const maths = all(tree.querySelectorAll(".math"));
  const unset = maths.filter(part => !part.querySelector(".katex"));
  here.formulas += maths.length - unset.length;
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
  frame.style = "border: 0; height: 900px";
  frame.style.width = widths[0] + "px";
  const loaded = new Promise(done => frame.onload = done);
  frame.src = "FOLDER/" + page;
  document.body.append(frame);
  await loaded;
  for (let i = 0; i < widths.length; ++i) {
    frame.style.width = widths[i] + "px";
    await new Promise(done => setTimeout(done, 100));
    look(page, frame.contentWindow, found[i]);
  }
  frame.remove();
}
onload = async () => {
  for (const page of PAGES) await open(page);
  document.getElementById("found").textContent = JSON.stringify(found);
};
</script>"""
# A window of chromium is no narrower than 500 pixels, but a frame is.
FRAME = """<!DOCTYPE html><body style="margin: 0"><iframe style="border: 0; height: HEIGHTpx; width: WIDTHpx"
 src="PAGE"></iframe>"""


class Browser:
    """Chromium without a window."""

    def __init__(self, chromium: str, site: Path) -> None:
        self._chromium = chromium
        self.site = site

    def shown(self, address: str, *options: str) -> str:
        """Returns what a page is when its scripts have ended."""
        with tempfile.TemporaryDirectory() as scratch:
            command = [self._chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
            command.append("--disable-dev-shm-usage")  # small in containers
            command += [f"--user-data-dir={scratch}", "--virtual-time-budget=1000000", *options, address]
            ended = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
        return ended.stdout

    def shown_text(self, text: str, *options: str) -> str:
        """Returns what the text of a page becomes, which may look into pages of the site."""
        with tempfile.TemporaryDirectory() as scratch:
            page = Path(scratch) / "page.html"
            page.write_text(text, encoding="utf-8")
            return self.shown(page.as_uri(), "--allow-file-access-from-files", *options)

    def look(self, pages: list[str]) -> list[dict[str, Any]]:
        """Returns for each width what is wrong on pages, and the number of formulas that are set."""
        text = LOOK.replace("WIDTHS", json.dumps(WIDTHS)).replace("FOLDER", self.site.as_uri())
        shown = self.shown_text(text.replace("PAGES", json.dumps(pages)), "--dump-dom")
        found = re.search(r'<pre id="found">(\[.*?\])</pre>', shown, re.DOTALL)
        if not found:
            raise SystemExit("browser.py: chromium did not come to the end of the pages")
        return list(json.loads(html.unescape(found[1])))

    def hits(self, words: str) -> list[str]:
        """Returns the titles of the pages that the page of the search lists."""
        shown = self.shown(f"{(self.site / 'search.html').as_uri()}?q={quote(words)}", "--dump-dom")
        found = re.search(r'<ul class="search">(.*?)</ul>', shown, re.DOTALL)
        titles = re.findall(r"<li[^>]*>\s*<a [^>]*>(.*?)</a>", found[1] if found else "", re.DOTALL)
        return [html.unescape(title) for title in titles]

    def keep_picture(self, page: str, width: int, file: Path) -> None:
        """Writes a picture of the upper part of a page at a width [pixels]."""
        text = FRAME.replace("PAGE", (self.site / page).as_uri()).replace("HEIGHT", str(HEIGHT))
        options = (f"--screenshot={file}", f"--window-size={max(width, 500)},{HEIGHT}")
        self.shown_text(text.replace("WIDTH", str(width)), *options)
        if not file.exists():
            raise SystemExit(f"browser.py: chromium did not draw {file}")


def check(browser: Browser, pages: list[str]) -> int:
    """Prints what is wrong; returns the number of faults."""
    n_faults = 0
    with ThreadPoolExecutor(2) as pool:
        halves = pool.map(browser.look, (pages[::2], pages[1::2]))
        searches = pool.map(browser.hits, TERMS)
    for width, *looks in zip(WIDTHS, *halves):
        faults = [fault for look in looks for fault in look["faults"]]
        formulas = sum(look["formulas"] for look in looks)
        faults += [] if formulas else ["no page shows a formula"]
        counts = f"{len(pages)} pages at {width} pixels, {formulas} formulas, {len(faults)} faults"
        print("\n".join([*faults, counts]))
        n_faults += len(faults)
    for words, titles in zip(TERMS, searches):
        print(f"search for '{words}': {len(titles)} pages" + (f", first '{titles[0]}'" if titles else ""))
        n_faults += not titles
    return n_faults


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(description="Looks at the pages of the site in chromium.")
    parser.add_argument("site", type=Path)
    parser.add_argument("--pictures", type=Path, help="write pictures of six pages to this folder")
    options = parser.parse_args()
    site = options.site.resolve()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        print("browser.py: no chromium (scripts/packages.sh documentation)", file=sys.stderr)
        return LACKING
    browser = Browser(chromium, site)
    paths = (path.relative_to(site) for path in sorted(site.rglob("*.html")))
    pages = [path.as_posix() for path in paths if path.parts[:2] != ("reference", "cpp")]
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
        for page, width in itertools.product(SHOWN, WIDTHS):
            if page in pages:  # without the program some are not there
                name = f"{page.removesuffix('.html').replace('/', '_')}_{width}.png"
                browser.keep_picture(page, width, options.pictures.resolve() / name)
        return 0
    return 1 if check(browser, pages) else 0


if __name__ == "__main__":
    sys.exit(main())
