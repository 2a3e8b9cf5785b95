"""`carom validate`: the quick set passes, says what it was measured against, and makes a page that stands alone."""

import html.parser
import json
import math
import unittest

from carom_cli import CliTest, figure

QUICK_SECONDS = 280  # 2 minutes on two quiet cores; tests share theirs


class Page(html.parser.HTMLParser):
    """Counts elements, and sees that each that is opened is closed."""

    VOID = {"meta", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.counts, self.links, self.mistakes = [], {}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.counts[tag] = self.counts.get(tag, 0) + 1
        self.links += [value for name, value in attrs if name in ("src", "href")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.counts[tag] = self.counts.get(tag, 0) + 1

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.mistakes.append(tag)


class Validate(CliTest):
    def test_quick_set(self):
        process = self.start("validate", "--json", "--html", "page.html")
        out, err = process.communicate(timeout=QUICK_SECONDS)
        report = json.loads(out)
        rows = report["rows"]
        failed = [row for row in rows if row["verdict"] != "pass"]
        self.assertEqual(failed, [], err)
        self.assertEqual(process.returncode, 0)
        self.assertGreater(len(rows), 70)
        self.assertGreater(len(report["not_tested"]), 3)

        sigmas = [row["sigmas"] for row in rows if row["sigmas"] is not None]
        rms = math.sqrt(sum(sigma * sigma for sigma in sigmas) / len(sigmas))
        figure(f"validate: {len(rows)} rows pass; {len(sigmas)} with a standard error, rms {rms:.2f} of them (0.6 to 1.4)")
        self.assertGreater(len(sigmas), 25)
        self.assertTrue(0.6 < rms < 1.4, rms)
        for row in rows:
            self.assertTrue(row["setup"] and row["source"], row)
            if row["sigmas"] is not None:
                self.assertLessEqual(abs(row["sigmas"]), 4)
                self.assertGreater(row["standard_error"], 0)
            self.assertLessEqual(abs(row["measured"] - row["reference"]), max(row["admitted"], 0) or math.inf)

        text = self.read("page.html").decode()
        page = Page(text)
        self.assertEqual((page.open, page.mistakes, page.links), ([], [], []))
        self.assertEqual(page.counts["svg"], 11)
        self.assertEqual(page.counts["tr"], len(rows) + 1)
        self.assertNotIn("script", page.counts)

    def test_text_names_everything(self):
        out, _ = self.carom("validate", "--only", "chains")
        for word in ("pass  chain: impacts", "measured 10, reference 10", "Newton's cradle", "Not tested:", "0 failed"):
            self.assertIn(word, out)

    def test_one_group_gives_the_same_bytes(self):
        first = self.carom("validate", "--only", "symmetry", "--json", "--html", "a.html")
        self.assertEqual(first, self.carom("validate", "--only", "symmetry", "--json", "--html", "b.html"))
        self.assertEqual(self.read("a.html"), self.read("b.html"))

    def test_bad_usage(self):
        message = self.refused("validate", "--only", "weather")
        self.assertIn("--only must be one of two_bodies, bouncing,", message)
        self.assertIn("'weather'", message)
        self.assertIn("--help", self.refused("validate", "--fast"))
        self.assertIn("page.html", self.refused("validate", "--only", "drag", "--html", "missing/page.html", expect=1))


if __name__ == "__main__":
    unittest.main()
