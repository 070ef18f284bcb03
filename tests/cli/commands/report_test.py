"""The lighting designer's report: a self-contained page with the numbers of probe."""

import re
import signal
import subprocess
import unittest
from html.parser import HTMLParser

from command import BAD_INPUT, COMMAND, LAMP, WRONG_USAGE, CommandTest, vertices

VOID = {"meta", "img", "link", "br", "hr"}
FLOORS = {"office": (0, 4), "hall": (4, 6)}  # x from, to
HEIGHT, WIDTH = 2.5, 3
FEW = ("--size", "32x18", "--samples")


def rectangle(name, origin, u, v, number):
    corners = [
        tuple(o + a * s + b * t for o, a, b in zip(origin, u, v, strict=True)) for s, t in ((0, 0), (1, 0), (1, 1), (0, 1))
    ]
    text = vertices(*corners).replace("v v", f"v v{number}_")
    return f"{text}o {name}\nf " + " ".join(f"v{number}_{k}" for k in range(4)) + "\no\n"


def two_rooms():
    """A hall 6 m long, without a wall between its two floors, and a lamp of 1000 lm below its ceiling."""
    faces = [
        *((f"{name}.floor", (x0, 0, 0), (x1 - x0, 0, 0), (0, WIDTH, 0)) for name, (x0, x1) in FLOORS.items()),
        ("ceiling", (0, 0, HEIGHT), (0, WIDTH, 0), (6, 0, 0)),
        ("wall", (0, 0, 0), (6, 0, 0), (0, 0, HEIGHT)),
        ("wall", (0, WIDTH, 0), (0, 0, HEIGHT), (6, 0, 0)),
        ("wall", (0, 0, 0), (0, 0, HEIGHT), (0, WIDTH, 0)),
        ("wall", (6, 0, 0), (0, WIDTH, 0), (0, 0, HEIGHT)),
    ]
    paint = "m paint<b>&amp; =\n\trd .5\n"
    lamp = LAMP + rectangle("lamp", (1, 1, 2.4), (0, 1, 0), (1, 0, 0), len(faces))
    return paint + "".join(rectangle(*face, number) for number, face in enumerate(faces)) + lamp


class Page(HTMLParser):
    """Checks that tags are balanced. Collects tables by id and all referenced addresses."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tables, self.addresses, self.tags, self.text = [], {}, [], set(), ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.tags.add(tag)
        self.addresses += [values[name] for name in ("src", "href") if name in values]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "table":
            self.rows = self.tables[values["id"]] = []
        elif tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag, attributes):
        self.addresses += [value for name, value in attributes if name in ("src", "href")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, f"</{tag}> closes another tag"

    def handle_data(self, data):
        self.text += data
        if "td" in self.open or "th" in self.open:
            self.rows[-1][-1] += data


class Report(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("rooms.mgf", two_rooms())
        self.write_solution("rooms.h5", "rooms.mgf", "--rays", "200k")

    def report(self, *arguments, samples=16):
        self.interflect("report", "rooms.h5", "-o", "page.html", *FEW, samples, *arguments)
        page = Page((self.folder / "page.html").read_text())
        self.assertEqual(page.open, [])
        return page

    def test_has_the_numbers_of_probe(self):
        page = self.report("--ugr", "--eye-height", "1.1", samples=256)
        head, *rows = page.tables["results"]
        self.assertEqual(head[0], "Measuring area")
        for name, row in zip(("office", "hall"), rows, strict=True):
            (area,) = self.json("probe", "rooms.h5", "--plane", "0.75", "--over", f"{name}.floor", "--samples", "256")["areas"]
            self.assertEqual(row[0], f"{name}.floor, z = 0.75 m")
            self.assertEqual(int(row[1]), area["points"])
            mean, error = float(row[3]), float(row[8])
            self.assertAlmostEqual(mean, area["mean"], delta=6 * error + 0.006 * mean)
            self.assertAlmostEqual(float(row[6]), area["uniformity"], delta=0.05)
        self.assertEqual([row[:2] for row in page.tables["rooms"][1:]], [["office.floor", "12.00"], ["hall.floor", "6.00"]])
        (lamp,) = page.tables["lights"][1:]
        self.assertEqual(lamp[1:], ["surface", "1", "1000", "318"])
        glare = {row[0]: float(row[2]) for row in page.tables["glare"][1:]}
        ratings = self.json(
            "probe", "rooms.h5", "--quantity", "ugr", "--plane", "1.1", "--over", "office.floor", "--samples", "256"
        )["areas"]
        self.assertAlmostEqual(glare["office.floor, z = 1.1 m"], max(area["max"] for area in ratings), delta=0.2)

    def test_planes_have_the_strip_along_walls_and_desks_do_not(self):
        places = ("--plane", "0.7", "--over", "office.floor", "--boundary", "--spacing", "0.3")
        (plane,) = self.json("probe", "rooms.h5", *places, "--samples", "16")["areas"]
        page = self.report(*places, "--grid", "office.floor")
        rows = {row[0]: int(row[1]) for row in page.tables["results"][1:]}
        self.assertEqual(rows["office.floor, z = 0.7 m"], plane["points"])
        self.assertGreater(rows["office.floor"], plane["points"])

    def test_captions_have_the_size_of_the_floor(self):
        self.assertEqual(self.report().text.count("6.00 × 3.00 m; x to the right"), 2)

    def test_rates_seats_by_their_own_direction(self):
        seat = ("--seat", "1,1,1.2:0,1,0")
        (rating,) = self.json("probe", "rooms.h5", "--quantity", "ugr", *seat, "--samples", "256")["areas"]
        rows = self.report(*seat, samples=256).tables["glare"][1:]
        self.assertEqual([row[0] for row in rows], ["seat 1", "seat 1, worst direction"])
        self.assertAlmostEqual(float(rows[0][2]), rating["ugr"], delta=0.2)
        self.assertAlmostEqual(float(rows[1][2]), rating["worst_direction"]["ugr"], delta=0.2)
        self.assertEqual(rows[0][4], "0 1 0")
        self.assertGreater(rating["worst_direction"]["ugr"], rating["ugr"])

    def test_needs_nothing_else_and_escapes_names(self):
        page = self.report("--title", "<script>alert('&')</script>", "--date", "1 < 2")
        self.assertIn("<script>alert('&')</script>", page.text)
        self.assertIn("1 < 2", page.text)
        self.assertIn("paint<b>&amp;", [row[0] for row in page.tables["surfaces"]])
        self.assertNotIn("script", page.tags)
        self.assertNotIn("b&gt;", page.tags)
        self.assertGreaterEqual(len(page.addresses), 4)
        for address in page.addresses:
            self.assertRegex(address, r"^data:image/png;base64,[A-Za-z0-9+/]+={0,2}$")

    def test_draws_the_views_of_the_scene(self):
        page = self.report()
        self.assertEqual(page.text.count("and illuminance of the visible surfaces"), 1)
        self.interflect("report", "rooms.h5", "-o", "view.html", *FEW, 16, "--eye", "1,1,1", "--look-at", "3,1,1")
        self.assertEqual((self.folder / "view.html").read_text().count("data:image/png"), 2 + 2)

    def test_is_the_same_on_any_number_of_threads(self):
        pages = []
        for threads in ("1", "2"):
            self.report("--threads", threads, "--date", "today")
            pages.append(self.bytes("page.html"))
        self.assertEqual(*pages)

    def test_faults_say_what_was_expected(self):
        for arguments, words, exit_code in (
            (["--working-plane", "-1"], "floor", BAD_INPUT),
            (["--grid", "desk"], "'desk'", BAD_INPUT),
            (["--view", "door"], "door", BAD_INPUT),
            (["--working-plane", "high"], "--working-plane", WRONG_USAGE),
            (["--exterior", "0"], "--exterior", WRONG_USAGE),
            (["--size", "0x4"], "--size", WRONG_USAGE),
        ):
            with self.subTest(arguments):
                result = self.interflect("report", "rooms.h5", "-o", "page.html", *arguments, exit_code=exit_code)
                self.assertIn(words, result.stderr)
        self.interflect("report", "rooms.mgf", "-o", "page.html", exit_code=BAD_INPUT)
        self.interflect("report", "rooms.h5", "-o", "rooms.h5", exit_code=WRONG_USAGE)
        self.assertEqual(self.files(), ["rooms.h5", "rooms.mgf"])

    def test_an_interruption_writes_nothing(self):
        process = subprocess.Popen(
            [COMMAND, "report", "rooms.h5", "-o", "page.html", "--samples", "16000000"],
            cwd=self.folder, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        self.assertRegex(process.stderr.readline(), re.compile("rays|%"))
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=30)
        self.assertEqual(process.returncode, -signal.SIGINT, messages)
        self.assertNotIn("keeping", messages)
        self.assertEqual(self.files(), ["rooms.h5", "rooms.mgf"])


if __name__ == "__main__":
    unittest.main()
