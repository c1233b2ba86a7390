"""Checks the pages of a book as built: every link and picture within leads to a file, and every anchor to an element."""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The links and the anchors of a page."""

    def __init__(self, path: Path):
        super().__init__()
        self.links: list[tuple[int, str]] = []
        self.anchors: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(attributes[name] for name in ("id", "name") if attributes.get(name))
        for name in ("href", "src"):
            if attributes.get(name):
                self.links.append((self.getpos()[0], attributes[name]))


def main(book: Path) -> int:
    # The page of all chapters at once repeats their headings, and 404 is shown at any depth.
    left_out = {"print.html", "404.html", "toc.html"}
    paths = sorted(path for path in book.rglob("*.html") if path.name not in left_out)
    pages = {path.resolve(): Page(path) for path in paths}
    checked, broken = 0, []
    for path, page in pages.items():
        for line, link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or parts.path.endswith("print.html"):
                continue
            checked += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            anchor = unquote(parts.fragment)
            if not target.exists():
                broken.append(f"{path}:{line}: there is no {link}")
            elif anchor and target in pages and anchor not in pages[target].anchors:
                broken.append(f"{path}:{line}: there is no #{anchor} in {target}")
    broken = list(dict.fromkeys(broken))
    print("\n".join(broken), file=sys.stderr, end="\n" if broken else "")
    print(f"docs/check: {len(pages)} pages, {checked} links, {len(broken)} broken", file=sys.stderr)
    if not pages or not checked:
        print("docs/check: nothing was checked", file=sys.stderr)
        return 1
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
