"""What has to hold for the README and the book whatever the program finds: links lead somewhere, the summary lists the chapters,
every key has its chapter, the README is short, and what it shows of the sources is what they say.

Each check gives a list of faults. Pages are named from the root of the repository.
"""
import json
import pathlib
import re
import tomllib

MOST_WORDS = 1200  # of the README, as `wc -w` counts
CODE = re.compile(r"^```.*?^```[^\n]*$", re.M | re.S)
LINK = re.compile(r"!?\[(?:[^\]\[]|\[[^\]]*\])*\]\(([^)\s]+)\)")


def pages(root):
    """The pages that are read: README, chapters of the book, findings."""
    return [root / "README.md", *sorted((root / "docs/src").glob("*.md")), *sorted((root / "validation").glob("*.md"))]


def blocks(text, language):
    """The code blocks in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.M | re.S)


def anchors(text):
    """The anchors of a page: its headings as GitHub and mdbook make anchors of them."""
    headings = re.findall(r"^#+ +(.+?) *$", CODE.sub("", text), re.M)
    found, times = set(), {}
    for heading in headings:
        words = re.sub(r"\]\([^)]*\)", "", heading).lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        times[slug] = times.get(slug, -1) + 1
        found.add(f"{slug}-{times[slug]}" if times[slug] else slug)
    return found


def dead_links(root):
    """Relative links to files that are not there, outside of the repository, or to headings that a page does not have."""
    wrong = []
    for page in pages(root):
        text = page.read_text()
        for target in LINK.findall(CODE.sub("", text)):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            name = page.relative_to(root)
            if not file.is_relative_to(root.resolve()) or not file.exists():
                wrong.append(f"{name}: the link to {target} leads nowhere")
            elif anchor and anchor not in anchors(file.read_text()):
                wrong.append(f"{name}: the link to {target} names a heading that is not there")
    return wrong


def missing_names(root):
    """Files and benches that a page names in its text or in a command, and that are not there."""
    benches = {bench["name"] for bench in tomllib.loads((root / "Cargo.toml").read_text())["bench"]}
    wrong = []
    for page in pages(root):
        text, name = page.read_text(), page.relative_to(root)
        quoted = " ".join(re.findall(r"`([^`]+)`", text.replace("```", "")))
        files = set(re.findall(r"(?<![\w./-])(?:\.ci|benches|examples|meshes|src|tests)/[\w./-]*\w", quoted))
        wrong += [f"{name}: there is no {file}" for file in sorted(files) if not (root / file).exists()]
        wrong += [f"{name}: there is no bench {bench}" for bench in sorted(set(re.findall(r"--bench (\w+)", text)) - benches)]
    return wrong


def uneven_tables(root):
    """Rows of tables with more or fewer cells than their header: a `|` inside of a cell is written `\\|`."""
    wrong = []
    for page in pages(root):
        width = None
        for number, line in enumerate(CODE.sub(lambda code: "\n" * code[0].count("\n"), page.read_text()).split("\n"), 1):
            cells = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else None
            if cells and width and cells != width:
                wrong.append(f"{page.relative_to(root)}:{number}: the row has {cells - 1} cells, the header {width - 1}")
            width = (width or cells) if cells else None
    return wrong


def unlisted_chapters(root):
    """Chapters that the summary does not list, lists twice, or lists without their being there."""
    folder = root / "docs/src"
    listed = LINK.findall((folder / "SUMMARY.md").read_text())
    there = [file.name for file in folder.glob("*.md") if file.name != "SUMMARY.md"]
    wrong = [f"docs/src/SUMMARY.md does not list {name}" for name in sorted(set(there) - set(listed))]
    wrong += [f"docs/src/SUMMARY.md lists {name}, which is not there" for name in sorted(set(listed) - set(there))]
    return wrong + [f"docs/src/SUMMARY.md lists {name} twice" for name in sorted(set(listed)) if listed.count(name) > 1]


def long_readme(root):
    """Whether the README has become long."""
    words = len((root / "README.md").read_text().split())
    return [f"README.md has {words} words, more than {MOST_WORDS}"] if words > MOST_WORDS else []


def other_sources(root):
    """Scenes and programs in the README that are not those of the sources."""
    text = (root / "README.md").read_text()
    shown = [tomllib.loads(block) for block in blocks(text, "toml")]
    scene = tomllib.loads((root / "meshes/star.toml").read_text())
    wrong = [] if shown == [scene] else ["README.md: its scene is not meshes/star.toml"]
    docs = "".join(re.findall(r"^//! ?(.*\n)", (root / "src/lib.rs").read_text(), re.M))
    tested = re.findall(r"^```\n(.*?)^```$", docs, re.M | re.S)
    if blocks(text, "rust") != tested[:1]:
        wrong.append("README.md: its program is not the first one of src/lib.rs")
    return wrong


def keys_in(schema):
    """The names of all keys that a part of a schema has, at any depth."""
    if isinstance(schema, list):
        return {key for part in schema for key in keys_in(part)}
    if not isinstance(schema, dict):
        return set()
    return set(schema.get("properties", {})) | keys_in(list(schema.values()))


def unexplained_keys(root):
    """Keys of studies that their chapter does not name, and keys of scenes and summaries that no chapter names."""
    schemas = {name: json.loads((root / f"validation/schema/{name}.json").read_text()) for name in ("scene", "summary")}
    chapters = {file.stem: file.read_text() for file in (root / "docs/src").glob("*.md")}
    named = {name: set(re.findall(r"\w+", " ".join(re.findall(r"`[^`\n]+`", text)))) for name, text in chapters.items()}
    wrong = []
    for kind in schemas["scene"]["$defs"]["StudySpec"]["oneOf"]:
        name = kind["properties"]["kind"]["const"]
        missing = sorted(set(kind["properties"]) - named.get(name, set()))
        wrong += [f"docs/src/{name}.md does not name the key `{key}` of its study" for key in missing]
    for name, schema in schemas.items():
        missing = sorted(keys_in(schema) - set().union(*named.values()))
        wrong += [f"no chapter of docs/src names the key `{key}` of a {name}" for key in missing]
    return wrong


def scenes_of(page):
    """The scenes in a page, and a name for each: blocks in TOML; those that are a part of a scene only, with a sheet and a study."""
    whole = {"sheet": {"generate": {"pattern": "miura"}}, "study": [{"name": "any", "kind": "branches"}]}
    found = blocks(pathlib.Path(page).read_text(), "toml")
    return [(f"{page}, scene {k + 1}", whole | tomllib.loads(block)) for k, block in enumerate(found)]


def faults(root):
    """All faults."""
    checks = dead_links, missing_names, uneven_tables, unlisted_chapters, long_readme, other_sources, unexplained_keys
    return [fault for check in checks for fault in check(root)]
