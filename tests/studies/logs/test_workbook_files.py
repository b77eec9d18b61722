"""Excel workbooks written by openpyxl, read back number by number."""
import datetime
import importlib
import math
import re
import unittest
import zipfile

from written_log import WrittenLogTest, read_log

try:
    openpyxl = importlib.import_module("openpyxl")
except ImportError:
    openpyxl = None
ROWS = 1500


@unittest.skipUnless(openpyxl, "python3-openpyxl is not installed")
class Workbooks(WrittenLogTest):
    def write(self):
        book = openpyxl.Workbook()
        sheet = book.active
        sheet.title = "Run 1"
        sheet.append(["A bench of a lab"])
        sheet.append([])
        sheet.append(["time [s]", "Force (N)", "phase", "when", "on"])
        self.begin = datetime.datetime(2024, 5, 1, 10, 0, 0)
        for k in range(ROWS):
            sheet.append([k / 1000, round(math.sin(k), 12), "go", self.begin + datetime.timedelta(milliseconds=250 * k), k % 2 == 0])
        sheet["B10"] = None
        sheet["B11"] = "#DIV/0!"
        other = book.create_sheet("Other & more")
        for k in range(20):
            other.append([k, k * k])
        book.create_sheet("Words").append(["nothing", "here"])
        book.create_sheet("Empty")
        path = self.folder / "log.xlsx"
        book.save(path)
        return path

    def with_shared_texts(self, path):
        """As Excel itself writes texts: once, in a part of their own, some in pieces."""
        texts = []

        other = path.with_name("shared.xlsx")
        with zipfile.ZipFile(path) as before, zipfile.ZipFile(other, "w", zipfile.ZIP_DEFLATED) as after:
            for name in before.namelist():
                content = before.read(name)
                if name.startswith("xl/worksheets/"):
                    content = re.sub(rb't="inlineStr"><is><t[^>]*>([^<]*)</t></is>',
                                     lambda found: (texts.append(found.group(1)), b't="s"><v>%d</v>' % (len(texts) - 1))[1], content)
                    self.assertNotIn(b"inlineStr", content)
                after.writestr(name, content)
            pieces = b"".join(b"<si><r><t>" + text[:2] + b"</t></r>\n<r><t>" + text[2:] + b"</t></r></si>" for text in texts)
            after.writestr("xl/sharedStrings.xml", b"<sst>" + pieces + b"</sst>")
        return other

    def test_sheets_are_tables(self):
        path = self.write()
        for one in (path, self.with_shared_texts(path)):
            with self.subTest(one.name):
                self.check(one)

    def check(self, path):
        log = read_log(path)
        self.assertEqual(log.format, "Excel workbook")
        force = [round(math.sin(k), 12) for k in range(ROWS)]
        force[6] = force[7] = math.nan
        self.assertEqual(log.units["Run 1"], {"time": "s", "Force": "N", "when": "s", "on": ""})
        self.assert_numbers(log.tables["Run 1"], {"time": [k / 1000 for k in range(ROWS)], "Force": force,
                                                  "when": [k / 4 for k in range(ROWS)], "on": [k % 2 == 0 for k in range(ROWS)]})
        self.assert_numbers(log.tables["Other & more"], {"column_1": range(20), "column_2": [k * k for k in range(20)]})
        for words in ("Sheet 'Run 1': A column of text is left out: phase",
                      "Sheet 'Words': it is left out", "Sheet 'Empty': it is empty"):
            self.assertIn(words, log.remarks)
        self.assertIn("Sheet 'Run 1': 'when' is read as seconds since its first row, 2024-05-01T10:00:00", log.assumptions)

    def test_cuts_are_refused(self):
        self.assert_cuts_are_told(self.write())

    def change(self, path, part, change):
        other = path.with_name("changed.xlsx")
        with zipfile.ZipFile(path) as before, zipfile.ZipFile(other, "w", zipfile.ZIP_DEFLATED) as after:
            for name in before.namelist():
                after.writestr(name, change(before.read(name)) if name == part else before.read(name))
        return other

    def test_entities_of_its_own_are_refused(self):
        path = self.change(self.write(), "xl/workbook.xml",
                           lambda xml: b'<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]>' + xml[xml.index(b"<workbook"):])
        self.assertIn("xl/workbook.xml in it is not XML of a workbook", read_log(path).refusal)

    def test_a_bomb_is_refused(self):
        path = self.change(self.write(), "xl/worksheets/sheet1.xml",
                           lambda xml: xml.replace(b"<sheetData>", b"<sheetData>" + b" " * (600 << 20)))
        self.assertIn("unpacks to far more than a workbook does", read_log(path).refusal)

    def test_another_archive_is_refused(self):
        path = self.folder / "log.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("log.csv", "t,x\n0,1\n")
        self.assertIn("ZIP archive without an Excel workbook", read_log(path).refusal)


if __name__ == "__main__":
    unittest.main()
