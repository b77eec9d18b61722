"""What `capstan import` names of the faults in generated logs. Without python3-rosbag and the like those formats are left out."""

import importlib.util
import unittest

import import_trial

NEEDS = {"mat": "scipy", "hdf5": "h5py", "xlsx": "openpyxl", "bag": "rosbag"}


class PlantedFaults(unittest.TestCase):
    def test_faults_are_named_and_nothing_else_is(self):
        formats = [name for name in import_trial.WRITERS if importlib.util.find_spec(NEEDS.get(name, "json"))]
        print("formats:", ", ".join(formats))
        by_kind, false, missed, _ = import_trial.run(12 * len(formats), 20, formats)
        planted = sum(count - doubted for count, _, doubted in by_kind.values())
        found = sum(hit for _, hit, _ in by_kind.values())
        self.assertGreater(planted, 10 * len(formats))
        self.assertGreaterEqual(found, 0.95 * planted, missed)
        self.assertLessEqual(len(false), 0.05 * 12 * len(formats), false)


if __name__ == "__main__":
    unittest.main()
