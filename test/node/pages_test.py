#!/usr/bin/env python3
"""The pages of docs/: links lead to pages and headings that are there, the tutorial's cases are cases, and every page is in the site's list."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DOCS = os.path.join(ROOT, "docs")


def pages():
    found = [os.path.join(ROOT, name) for name in os.listdir(ROOT) if name.endswith(".md")]
    for folder, _, names in os.walk(DOCS):
        found += [os.path.join(folder, name) for name in names if name.endswith(".md")]
    return sorted(found)


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"(?ms)^```.*?^```", "", text))


def anchors(path):
    """As GitHub and mkdocs name headings: small letters, blanks as hyphens, without other marks."""
    names = set()
    for heading in re.findall(r"(?m)^#+ (.*)$", re.sub(r"(?ms)^```.*?^```", "", text_of(path))):
        words = re.sub(r"[^\w\- ]", "", heading.strip().lower())
        names.add(words.replace(" ", "-"))
    return names


class Pages(unittest.TestCase):
    def test_links_lead_somewhere(self):
        count = 0
        for page in pages():
            for link in re.findall(r"\[[^]]*\]\(([^)\s]+)\)", without_code(text_of(page))):
                if "://" in link:
                    continue
                target, _, anchor = link.partition("#")
                path = os.path.normpath(os.path.join(os.path.dirname(page), target)) if target else page
                with self.subTest(page=os.path.relpath(page, ROOT), link=link):
                    self.assertTrue(os.path.exists(path), "leads nowhere")
                    if anchor:
                        self.assertIn(anchor, anchors(path))
                count += 1
        self.assertGreater(count, 100)

    def test_every_page_is_in_the_site(self):
        listed = set(re.findall(r"[\w/]+\.md", text_of(os.path.join(ROOT, "mkdocs.yml"))))
        self.assertEqual(listed, {os.path.relpath(page, DOCS) for page in pages() if page.startswith(DOCS)})


class References(unittest.TestCase):
    def setUp(self):
        self.page = text_of(os.path.join(DOCS, "references.md"))

    def test_each_has_its_year_and_how_it_is_found(self):
        entries = [" ".join(entry.split()) for entry in re.findall(r"(?ms)^- (.*?)(?=^- |^#|\Z)", self.page)]
        self.assertGreater(len(entries), 30)
        for entry in entries:
            with self.subTest(entry[:80]):
                self.assertRegex(entry, r"\((19|20)\d\d\)")
                self.assertRegex(entry, r"\]\(https://doi\.org/10\.\d{4}/\S+\)$|DOI( is not known here)?\.$")

    def test_whoever_is_cited_with_a_year_is_there(self):
        name = r"[A-ZŽ][\wéèöüäžć-]+"
        cited = set()
        for page in set(pages()) - {os.path.join(DOCS, "references.md")}:
            text = re.sub(r"\s+", " ", without_code(text_of(page)))
            cited.update(re.findall(r"(%s)(?: (?:and|&) %s| et al\.)?,? \(?(?:19|20)\d\d\b" % (name, name), text))
        self.assertLessEqual({"Mansard", "Madsen", "Ursell"}, cited)
        for author in sorted(cited):
            self.assertIn(author, self.page)


class Gallery(unittest.TestCase):
    def test_has_every_demo_and_its_picture(self):
        demos = {name[: -len(".yaml")] for name in os.listdir(os.path.join(ROOT, "config")) if name.endswith(".yaml")}
        demos |= {name[: -len(".launch")] for name in os.listdir(os.path.join(ROOT, "launch"))} - {"wavetank"}
        text, whole = text_of(os.path.join(DOCS, "gallery.md")), 0
        self.assertEqual(set(re.findall(r"(?m)^## (\w+)$", text)), demos, "scripts/validate gallery writes it, of the list in test/validation/gallery.py")
        for demo in demos:
            self.assertIn("(images/gallery/%s.jpg)" % demo, text)
            size = os.path.getsize(os.path.join(DOCS, "images", "gallery", demo + ".jpg"))
            self.assertLess(size, 60e3, demo)
            whole += size
        self.assertLess(whole, 1.5e6)


class Version(unittest.TestCase):
    def test_is_the_packages(self):
        (version,) = re.findall(r"<version>(.*)</version>", text_of(os.path.join(ROOT, "package.xml")))
        self.assertEqual(re.findall(r"(?m)^version: (.*)$", text_of(os.path.join(ROOT, "CITATION.cff"))), [version])


class Tutorial(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()

    def tearDown(self):
        shutil.rmtree(self.folder)

    def test_its_cases_are_taken(self):
        cases = []
        for page in sorted(os.listdir(os.path.join(DOCS, "tutorial"))):
            text = text_of(os.path.join(DOCS, "tutorial", page))
            for mesh, name in re.findall(r"(?m)^cp (meshes/\S+) (\S+)$", text):
                shutil.copy(os.path.join(ROOT, mesh), os.path.join(self.folder, name))
            blocks = re.findall(r"(?ms)`([\w.]+\.(?:yaml|urdf))`[.:]\n\n```(?:yaml|xml)\n(.*?)^```", text)
            self.assertEqual(len(blocks), len(re.findall(r"(?m)^```(?:yaml|xml)$", text)), page + ": a file without a name before it")
            for name, content in blocks:
                with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                    file.write(content)
                if name.endswith(".yaml"):
                    cases.append(name)
        self.assertEqual(len(cases), 4)
        for case in cases:
            with self.subTest(case=case):
                check = subprocess.run(
                    [os.environ["WAVETANK_RUN"], "--check", case], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True
                )
                self.assertEqual(check.returncode, 0, check.stderr)


if __name__ == "__main__":
    unittest.main()
