"""Writes docs/method/results.md as a single HTML file with embedded figures."""

import base64
import re
from pathlib import Path

import markdown

STYLE = """
body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 sans-serif; color: #222 }
table { border-collapse: collapse; margin: 1rem 0 } td, th { border: 1px solid #ccc; padding: .2rem .6rem; text-align: left }
img { max-width: 100% } code { background: #f3f3f3; padding: 0 .2em }
"""
TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


def write_page(source: Path, target: Path) -> None:
    """Embeds the figures that the text links to, relative to its folder."""
    body = markdown.markdown(source.read_text(), extensions=["tables", "fenced_code"])

    def embedded(match: re.Match) -> str:
        picture = source.parent / match[1]
        if picture.suffix not in TYPES or not picture.is_file():
            return match[0]
        return f'src="data:{TYPES[picture.suffix]};base64,{base64.b64encode(picture.read_bytes()).decode()}"'

    body = re.sub(r'src="([^":]+)"', embedded, body)
    title = source.read_text().partition("\n")[0].lstrip("# ")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(
        f'<!DOCTYPE html>\n<html lang="en">\n<meta charset="utf-8">\n<title>Interflect: {title}</title>\n'
        f"<style>{STYLE}</style>\n{body}\n</html>\n"
    )
