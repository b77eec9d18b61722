"""MATLAB files written by scipy and h5py, HDF5 files written by h5py, read back number by number."""
import importlib
import math
import struct
import unittest
import zlib

from written_log import WrittenLogTest, read_log


def installed(module):
    try:
        return importlib.import_module(module)
    except ImportError:
        return None


np, scipy_io, h5py = installed("numpy"), installed("scipy.io"), installed("h5py")
ROWS = 5000


@unittest.skipUnless(np and scipy_io, "python3-scipy is not installed")
class MatlabFiles(WrittenLogTest):
    def variables(self):
        random = np.random.default_rng(1)
        return {"t": np.arange(ROWS) * 1e-3, "x": random.standard_normal((ROWS, 3)), "Fs": 1000.0,
                "counts": np.arange(ROWS, dtype=np.int32)[:, None], "wide": random.standard_normal((2, 700)),
                "note": "a lab's own", "z": np.array([1 + 2j, 3])}

    def check_top(self, log, values, complex_name="z"):
        x = values["x"]
        self.assert_numbers(log.tables[""], {"t": values["t"], "x(:,1)": x[:, 0], "x(:,2)": x[:, 1], "x(:,3)": x[:, 2],
                                             "counts": values["counts"][:, 0]})
        self.assert_numbers(log.tables["Fs"], {"Fs": [1000.0]})
        self.assert_numbers(log.tables["wide(1,:)"], {"wide(1,:)": values["wide"][0], "wide(2,:)": values["wide"][1]})
        self.assertIn("note (text)", log.remarks)
        self.assertIn(f"{complex_name} (complex)", log.remarks)

    def test_versions_4_and_5(self):
        for version, compressed in (("4", False), ("5", False), ("5", True)):
            with self.subTest(version=version, compressed=compressed):
                path, values = self.folder / "log.mat", self.variables()
                scipy_io.savemat(path, values, format=version, do_compression=compressed, oned_as="column")
                log = read_log(path)
                self.assertEqual(log.format, f"MATLAB {version}")
                self.check_top(log, values)

    def test_a_struct_is_a_table_and_a_struct_in_it_part_of_it(self):
        t = np.arange(ROWS) * 0.01
        run = {"time": t[:, None], "signals": {"values": np.stack([t, 2 * t], axis=1), "label": "torque"}, "gain": 3.0,
               "flags": np.arange(ROWS)[:, None] % 2 == 0}
        runs = np.empty((2,), dtype=[("t", object), ("F", object)])
        runs[0] = (np.arange(10.0)[:, None], np.ones((10, 1)))
        runs[1] = (np.arange(20.0)[:, None], np.full((20, 1), 2, dtype=np.uint8))
        path = self.folder / "log.mat"
        for compressed in (False, True):
            scipy_io.savemat(path, {"run": run, "runs": runs, "cells": np.array([1, "a"], dtype=object)},
                             do_compression=compressed)
            log = read_log(path)
            self.assert_numbers(log.tables["run"], {"time": t, "signals.values(:,1)": t, "signals.values(:,2)": 2 * t,
                                                    "flags": [k % 2 == 0 for k in range(ROWS)]})
            self.assert_numbers(log.tables["run/gain"], {"gain": [3.0]})
            self.assert_numbers(log.tables["runs(1)"], {"t": np.arange(10), "F": [1] * 10})
            self.assert_numbers(log.tables["runs(2)"], {"t": np.arange(20), "F": [2] * 20})
            self.assertIn("run.signals.label (text)", log.remarks)
            self.assertIn("cells (a cell array)", log.remarks)

    def test_objects_are_named_and_what_to_save_instead(self):
        """Neither scipy nor Octave writes a `timeseries`: its bytes are put together as MATLAB's format has them."""
        def element(kind, data):
            return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)

        def matrix(*parts):
            body = b"".join(parts)
            return struct.pack("<II", 14, len(body)) + body

        def timeseries(name):
            place = struct.pack("<6I", 0xdd000000, 2, 1, 1, 1, 1)
            numbers = matrix(element(6, struct.pack("<II", 13, 0)), element(5, struct.pack("<ii", 6, 1)), element(1, b""), element(6, place))
            return matrix(element(6, struct.pack("<II", 17, 0)), element(1, name), element(1, b"MCOS"), element(1, b"timeseries"), numbers)

        def packed(variable):
            content = zlib.compress(variable)
            return struct.pack("<II", 15, len(content)) + content

        path = self.folder / "log.mat"
        for pack in (bytes, packed):
            scipy_io.savemat(path, {"t": np.arange(5.0)[:, None]})
            path.write_bytes(path.read_bytes() + pack(timeseries(b"torque")))
            log = read_log(path)
            self.assert_numbers(log.tables[""], {"t": range(5)})
            self.assertIn("torque (an object of the class timeseries)", log.remarks)
            self.assertIn("log.t = ts.Time", log.remarks)
        # What replaces it is a table, and so is what Simulink calls a structure with time.
        t = np.arange(5.0)[:, None]
        scipy_io.savemat(path, {"log": {"Time": t, "Data": np.hstack([t, 2 * t])}, "out": {"time": t, "signals": {"values": 3 * t}}})
        log = read_log(path)
        self.assert_numbers(log.tables["log"], {"Time": range(5), "Data(:,1)": range(5), "Data(:,2)": range(0, 10, 2)})
        self.assert_numbers(log.tables["out"], {"time": range(5), "signals.values": range(0, 15, 3)})

    def test_cuts_are_told(self):
        for version, compressed in (("4", False), ("5", False), ("5", True)):
            with self.subTest(version=version, compressed=compressed):
                path = self.folder / "log.mat"
                values = {f"x{k:02d}": np.random.default_rng(k).standard_normal((400, 1)) for k in range(20)}
                scipy_io.savemat(path, values, format=version, do_compression=compressed)
                complete = path.read_bytes()
                log = read_log(path)
                self.assert_numbers(log.tables[""], {name: value[:, 0] for name, value in values.items()})
                size = len(complete)
                for part in range(1, 50):
                    cut = self.folder / "cut.mat"
                    cut.write_bytes(complete[:size * part // 50])
                    log = read_log(cut)
                    if version == "4" and size * part // 50 % (size // 20) == 0:
                        continue  # it ends between two variables, and is as good as a complete one
                    self.assertTrue(log.refusal or "is cut; the" in log.remarks, f"{part}/50: {log.remarks}")
                    for name, got in log.tables.get("", {}).items():
                        self.assertEqual(got, list(values[name][:, 0]), f"{part}/50 {name}")

    def test_a_claim_of_four_gigabytes_is_refused(self):
        path = self.folder / "log.mat"
        scipy_io.savemat(path, {"x": np.ones((30, 1))}, format="5")
        complete = path.read_bytes()
        dims = complete.index(struct.pack("<II", 30, 1))
        path.write_bytes(complete[:dims] + struct.pack("<II", 1 << 29, 1) + complete[dims + 8:])
        log = read_log(path)
        self.assertTrue("it claims 536870912 x 1 numbers" in log.remarks or log.refusal, log.remarks)
        self.assertEqual(log.tables, {})


def write_version_73(path, variables):
    """As MATLAB's save -v7.3 does it: HDF5 behind 512 bytes, matrices transposed, their class as an attribute."""
    def state_class(item, name):
        text = h5py.h5t.C_S1.copy()
        text.set_size(len(name))
        attribute = h5py.h5a.create(item.id, b"MATLAB_class", text, h5py.h5s.create(h5py.h5s.SCALAR))
        attribute.write(np.array(name.encode()), mtype=text)

    def put(group, name, value):
        if isinstance(value, dict):
            inner = group.create_group(name)
            state_class(inner, "struct")
            letters = np.empty(len(value), dtype=object)
            for k, field in enumerate(value):
                letters[k] = np.frombuffer(field.encode(), dtype="S1")
            inner.attrs.create("MATLAB_fields", letters, dtype=h5py.vlen_dtype(np.dtype("S1")))
            for field, content in value.items():
                put(inner, field, content)
            return
        value = np.atleast_2d(np.asarray(value))
        names = {"float64": "double", "float32": "single"}
        dataset = group.create_dataset(name, data=value.T, chunks=True, compression="gzip")
        state_class(dataset, names.get(value.dtype.name, value.dtype.name))

    with h5py.File(path, "w", userblock_size=512, libver=("earliest", "v108")) as file:
        for name, value in variables.items():
            put(file, name, value)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Jan  1 00:00:00 2024 HDF5 schema 1.00 ."
    with open(path, "r+b") as file:
        file.write(head.ljust(116) + bytes(8) + b"\0\2IM")


@unittest.skipUnless(h5py, "python3-h5py is not installed")
class Hdf5Files(WrittenLogTest):
    def test_matlab_7_3(self):
        t = np.arange(ROWS) * 1e-3
        path = self.folder / "log.mat"
        write_version_73(path, {"t": t[:, None], "x": np.stack([t, -t], axis=1).astype(np.float32),
                                "run": {"t": t[:100, None], "n": np.arange(100, dtype=np.int16)[:, None]}})
        log = read_log(path)
        self.assertEqual(log.format, "MATLAB 7.3")
        small = t.astype(np.float32).astype(float)
        self.assert_numbers(log.tables[""], {"t": t, "x(:,1)": small, "x(:,2)": -small})
        self.assert_numbers(log.tables["run"], {"t": t[:100], "n": range(100)})

    def write(self, path):
        random = np.random.default_rng(2)
        self.force = random.standard_normal(ROWS)
        self.matrix = random.standard_normal((ROWS, 4)).astype(np.float32)
        table = np.zeros(300, dtype=[("index", "<i8"), ("values", "<f8", (3,)), ("word", "S4"), ("q", ">f4")])
        table["index"] = np.arange(300)
        table["values"] = random.standard_normal((300, 3))
        table["q"] = np.arange(300) / 2
        self.table = table
        with h5py.File(path, "w") as file:
            run = file.create_group("run1")
            run.create_dataset("force", data=self.force, chunks=(512,), compression="gzip").attrs["unit"] = "N"
            run.create_dataset("matrix", data=self.matrix).attrs.create("units", np.bytes_("rad"))
            run["on"] = np.arange(ROWS) % 2 == 0
            run["rate"] = 1000.0
            file["frame"] = table
            file["words"] = np.array([b"a", b"b"])
            file["cube"] = np.zeros((2, 2, 2))
            file["itself"] = h5py.SoftLink("/run1")
            file["away"] = h5py.ExternalLink("/etc/passwd", "/x")

    def test_datasets_groups_and_tables(self):
        path = self.folder / "log.h5"
        self.write(path)
        log = read_log(path)
        self.assertEqual(log.format, "HDF5")
        matrix = self.matrix.astype(float)
        self.assert_numbers(log.tables["run1"], {"force": self.force, **{f"matrix(:,{k + 1})": matrix[:, k] for k in range(4)},
                                                 "on": [k % 2 == 0 for k in range(ROWS)]})
        self.assertEqual(log.units["run1"], {"force": "N", **{f"matrix(:,{k + 1})": "rad" for k in range(4)}, "on": ""})
        self.assert_numbers(log.tables["run1/rate"], {"rate": [1000.0]})
        self.assert_numbers(log.tables["frame"], {"index": range(300), **{f"values.{k}": self.table["values"][:, k] for k in range(3)},
                                                  "q": np.arange(300) / 2})
        for words in ("words (text)", "cube (more than two dimensions)", "itself (a link)", "away (a link)", "as no number: word"):
            self.assertIn(words, log.remarks)

    def test_cuts_are_told(self):
        for name in ("log.h5", "log.mat"):
            path = self.folder / name
            if name == "log.h5":
                self.write(path)
            else:
                write_version_73(path, {"t": np.arange(ROWS)[:, None] * 1e-3})
            self.assert_cuts_are_told(path)

    def test_a_claim_that_no_file_can_hold_is_left_out(self):
        path = self.folder / "log.h5"
        with h5py.File(path, "w") as file:
            file.create_dataset("empty", shape=(1 << 29,), dtype="f8", chunks=(1 << 16,))
            file.create_dataset("lumps", shape=(1 << 25,), dtype="f8", chunks=(1 << 25,))
        log = read_log(path)
        self.assertIn("empty (it claims more numbers than the file can hold)", log.remarks)
        self.assertIn("lumps (", log.remarks)
        self.assertEqual(log.tables, {})

    def test_numbers_of_other_files_are_not_read(self):
        path = self.folder / "log.h5"
        (self.folder / "secret").write_bytes(struct.pack("<8d", *range(8)))
        with h5py.File(path, "w") as file:
            file.create_dataset("x", shape=(8,), dtype="f8", external=[(str(self.folder / "secret"), 0, 64)])
            file["t"] = np.arange(8.0)
        log = read_log(path)
        self.assertIn("x (in another file)", log.remarks)
        self.assert_numbers(log.tables[""], {"t": range(8)})


if __name__ == "__main__":
    unittest.main()
