"""What Skein writes as GeoJSON and as a flight plan, read by programs that know nothing of Skein: the packages geojson and
shapely, and the tables of QGroundControl's Plan File Format."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import geojson
    import shapely.geometry
    import shapely.ops
    import shapely.validation
except ImportError as missing:
    print(f"skipped: {missing}; Debian has python3-geojson and python3-shapely")
    sys.exit(77)

# docs.qgroundcontrol.com, Plan File Format: what each object must have.
PLAN = {"fileType": str, "geoFence": dict, "groundStation": str, "mission": dict, "rallyPoints": dict, "version": int}
MISSION = {"cruiseSpeed": (int, float), "firmwareType": int, "hoverSpeed": (int, float), "items": list,
           "plannedHomePosition": list, "vehicleType": int, "version": int}
ITEM = {"autoContinue": bool, "command": int, "doJumpId": int, "frame": int, "params": list, "type": str}


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        subprocess.run([PROGRAM, cls.folder.name], check=True)
        cls.texts = {path.name: path.read_text() for path in pathlib.Path(cls.folder.name).iterdir()}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def features(self, name):
        return geojson.loads(self.texts[name + ".geojson"])["features"]

    def test_geojson_finds_no_error_in_any_feature(self):
        for name in ("rhine", "fiji"):
            collection = geojson.loads(self.texts[name + ".geojson"])
            self.assertIsInstance(collection, geojson.FeatureCollection)
            self.assertEqual(7, len(collection["features"]))
            for feature in collection["features"]:
                self.assertTrue(feature.geometry.is_valid, feature.geometry.errors())

    def test_shapely_finds_every_outline_valid_and_against_the_clock(self):
        for name in ("rhine", "fiji"):
            for feature in self.features(name):
                shape = shapely.geometry.shape(feature["geometry"])
                self.assertTrue(shape.is_valid, shapely.validation.explain_validity(shape))
                polygons = getattr(shape, "geoms", [shape])
                for polygon in polygons:
                    if polygon.geom_type == "Polygon":
                        self.assertTrue(polygon.exterior.is_ccw, feature["properties"]["name"])

    def test_nothing_spans_the_antimeridian(self):
        crossing = 0
        for feature in self.features("fiji"):
            shape = shapely.geometry.shape(feature["geometry"])
            parts = list(getattr(shape, "geoms", [shape]))
            crossing += len(parts) > 1
            for part in parts:
                west, _, east, _ = part.bounds
                self.assertLess(east - west, 1)
                self.assertTrue(-180 <= west and east <= 180)
        self.assertEqual(2, crossing)  # Fork and the route

    def test_a_fence_at_the_antimeridian_is_the_zone_and_not_a_belt_around_the_earth(self):
        """An autopilot compares longitudes as plain numbers, and so does shapely."""
        zones = {feature["properties"]["name"]: shapely.geometry.shape(feature["geometry"]) for feature in self.features("fiji")}
        for name in ("fiji.plan", "fiji_read.plan"):
            fence = json.loads(self.texts[name])["geoFence"]
            polygons = [shapely.geometry.Polygon([(longitude, latitude) for latitude, longitude in polygon["polygon"]])
                        for polygon in fence["polygons"]]
            for polygon in polygons:
                self.assertTrue(polygon.is_valid, shapely.validation.explain_validity(polygon))
                west, _, east, _ = polygon.bounds
                self.assertLess(east - west, 1, name)
            # Sides that are straight in metres bend by some 30 m between corners that are 30 km apart.
            closed = shapely.ops.unary_union(polygons)
            for zone in ("Fork", "Town"):
                self.assertLess(zones[zone].difference(closed).area, 1e-3 * zones[zone].area, f"{zone} in {name}")

    def test_a_plan_has_all_that_its_format_asks_for(self):
        def has(what, fields):
            for field, kind in fields.items():
                self.assertIsInstance(what[field], kind, field)
        for name in ("rhine", "fiji"):
            plan = json.loads(self.texts[name + ".plan"])
            has(plan, PLAN)
            self.assertEqual(("Plan", 1), (plan["fileType"], plan["version"]))
            has(plan["mission"], MISSION)
            self.assertEqual(2, plan["mission"]["version"])
            self.assertEqual(3, len(plan["mission"]["plannedHomePosition"]))
            for item in plan["mission"]["items"]:
                has(item, ITEM)
                self.assertEqual(("SimpleItem", 7), (item["type"], len(item["params"])))
            fence = plan["geoFence"]
            self.assertEqual(2, fence["version"])
            places = [circle["circle"]["center"] for circle in fence["circles"]]
            for circle in fence["circles"]:
                self.assertGreater(circle["circle"]["radius"], 0)
                self.assertIs(circle["inclusion"], False)
            for polygon in fence["polygons"]:
                self.assertGreaterEqual(len(polygon["polygon"]), 3)
                places += polygon["polygon"]
            self.assertTrue(places)
            for latitude, longitude in places:
                self.assertLess(abs(latitude), 53)
                self.assertLessEqual(abs(longitude), 180)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
