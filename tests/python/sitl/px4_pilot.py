"""What a pilot does in PX4's own MAVSDK tests, with the same plugins, tolerances and times. Times are those of the vehicle."""

import math
import time

from mavsdk.plugins.action import Action
from mavsdk.plugins.action.action import ActionError
from mavsdk.plugins.failure import Failure
from mavsdk.plugins.failure.failure import FailureError
from mavsdk.plugins.follow_me import FollowMe
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.mission import Mission, MissionItem, MissionPlan
from mavsdk.plugins.mission.mission import MissionError
from mavsdk.plugins.mission_raw import MissionItem as RawItem
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.offboard import Offboard, PositionNedYaw, VelocityNedYaw
from mavsdk.plugins.offboard.offboard import OffboardError
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import LandedState, Telemetry

METRES_PER_DEGREE = 6371000 * math.pi / 180
# A vehicle whose time stands still ends a test, too; s of the wall clock.
LONGEST = 60.0


class Place:
    """A local frame at a place of the globe."""

    def __init__(self, latitude, longitude):
        assert math.isfinite(latitude) and math.isfinite(longitude)
        self.latitude, self.longitude = latitude, longitude
        self.east_scale = METRES_PER_DEGREE * math.cos(math.radians(latitude))

    def globe(self, north, east):
        return self.latitude + north / METRES_PER_DEGREE, self.longitude + east / self.east_scale

    def local(self, latitude, longitude):
        return (latitude - self.latitude) * METRES_PER_DEGREE, (longitude - self.longitude) * self.east_scale


def from_line(point, start, end):
    """From a point to the half line from one point through another."""
    length = math.dist(start, end) or 1.0
    way = [(b - a) / length for a, b in zip(start, end)]
    along = max(0.0, sum((p - a) * w for p, a, w in zip(point, start, way)))
    return math.dist(point, [a + along * w for a, w in zip(start, way)])


def raw_item(number, command, at=None, height=0.0, parameters=(0.0, 0.0), kind=0):
    """An item relative to home; `at` is its latitude and longitude, degrees."""
    item = RawItem()
    item.seq, item.command, item.current, item.autocontinue = number, command, int(number == 0), 1
    item.frame, item.x, item.y = (2, 0, 0) if at is None else (3, *(round(1e7 * degrees) for degrees in at))
    (item.param1, item.param2), item.param3, item.param4 = parameters, 0.0, 0.0
    item.z, item.mission_type = height, kind
    return item


class Pilot:
    """Everything that such a test holds. What it finds wrong on the way is collected in `wrong`."""

    def __init__(self, system):
        self.action, self.failure, self.follow, self.manual = Action(system), Failure(system), FollowMe(system), ManualControl(system)
        self.mission, self.raw, self.offboard = Mission(system), MissionRaw(system), Offboard(system)
        self.param, self.telemetry = Param(system), Telemetry(system)
        self.wrong, self.home = [], None

    def now(self):
        return self.telemetry.attitude_quaternion().timestamp_us / 1e6

    def sleep(self, seconds):
        end, latest = self.now() + seconds, time.monotonic() + LONGEST
        while self.now() <= end:
            assert time.monotonic() < latest, f"{seconds} s of the vehicle's time have not passed within {LONGEST} s"
            time.sleep(0.001)

    def holds(self, condition, seconds):
        began, end = self.now(), time.monotonic() + LONGEST
        while not condition():
            time.sleep(0.005)
            began = began or self.now()
            if self.now() - began > seconds or time.monotonic() > end:
                return False
        return True

    def require(self, condition, seconds, what):
        assert self.holds(condition, seconds), f"{what}: not within {seconds} s; {self.wrong[:3]}"

    def check(self, held, what):
        if not held:
            self.wrong.append(what)

    def ready(self):
        self.require(self.telemetry.health_all_ok, 30, "health")
        self.require(lambda: self.telemetry.health().is_armable, 45, "armable")

    def store_home(self):
        """By ground truth, as every place that is compared with it."""
        self.telemetry.set_rate_ground_truth(15.0)
        self.require(lambda: math.isfinite(self.telemetry.ground_truth().latitude_deg), 10, "ground truth")
        self.home = self.telemetry.ground_truth()

    def from_home(self, north=0.0, east=0.0):
        truth, home = self.telemetry.ground_truth(), Place(self.home.latitude_deg, self.home.longitude_deg)
        return math.dist(home.local(truth.latitude_deg, truth.longitude_deg), (north, east))

    def home_within(self, metres):
        self.check(self.from_home() < metres, f"{self.from_home():.2f} m from home, not within {metres}")

    def home_not_within(self, metres):
        self.check(self.from_home() > metres, f"{self.from_home():.2f} m from home, within {metres}")

    def place(self):
        home = self.telemetry.home()
        return Place(home.latitude_deg, home.longitude_deg)

    def position(self):
        at = self.telemetry.position_velocity_ned().position
        return at.north_m, at.east_m, at.down_m

    def airborne(self):
        self.require(lambda: self.telemetry.landed_state() == LandedState.IN_AIR, 45, "in air")

    def disarmed(self, seconds):
        self.require(lambda: not self.telemetry.armed(), seconds, "disarmed")

    def set(self, **values):
        for name, value in values.items():
            (self.param.set_param_float if isinstance(value, float) else self.param.set_param_int)(name, value)

    def arm(self):
        self.require(lambda: succeeds(self.action.arm, ActionError), 30, "arm")

    def take_off(self, height=None):
        """Armed before its height is set, as in the tests that follow a target."""
        self.arm()
        if height is not None:
            self.action.set_takeoff_altitude(height)
            assert self.action.get_takeoff_altitude() == height
        self.action.takeoff()
        self.airborne()

    def begin_to_follow(self):
        """MAVSDK takes a target only after a heartbeat has told the mode."""
        self.follow.start()
        self.require(self.follow.is_active, 60, "following")

    def begin_offboard(self, again):
        """MAVSDK forgets a set-point when a heartbeat comes between it and the start."""
        assert any(succeeds(self.offboard.start, OffboardError) or again() for _ in range(10)), "offboard"

    def goto(self, *target, within=0.3, seconds=60):
        def set_point():
            self.offboard.set_position_ned(PositionNedYaw(*map(float, target)))

        set_point()
        self.begin_offboard(set_point)
        self.check(self.holds(lambda: math.dist(self.position(), target[:3]) < within, seconds), f"{target}: not within {seconds} s")

    def offboard_land(self):
        self.offboard.set_velocity_ned(VelocityNedYaw(0.0, 0.0, 1.0, 0.0))

    def inject(self, unit, kind, instance, refusal=None):
        # MAVSDK reads this parameter when the plugin is made, and asks the vehicle if it is not known yet. Reads are answered in turn.
        self.param.get_param_int("SYS_FAILURE_EN")
        try:
            self.failure.inject(unit, kind, instance)
            result = None
        except FailureError as error:
            result = error.result.name
        self.check(result == refusal, f"{unit.name} {kind.name}: {result}, not {refusal}")

    def plan(self, points, back=False, through=False):
        """A mission over points north and east of home, m, at PX4's 10 m."""
        items = [MissionItem(*self.place().globe(*point), 10.0, is_fly_through=through) for point in points]
        for item in items:
            item.camera_photo_interval_s = math.nan
        self.mission.set_return_to_launch_after_mission(back)
        self.mission.upload_mission(MissionPlan(items))
        self.sleep(1)

    def square(self, **options):
        self.plan([(20, 0), (20, 20), (0, 20)], **options)

    def straight(self, **options):
        self.plan([(20 * number, 0) for number in range(5)], **options)

    def finish(self, seconds=500):
        def finished():
            try:
                return self.mission.is_mission_finished()
            except MissionError:
                return False

        self.require(finished, seconds, "mission finished")

    def fly_mission(self):
        self.require(lambda: succeeds(self.mission.start_mission, MissionError), 3, "mission started")
        self.finish()

    def to_item(self, number, mission=None):
        mission = mission or self.mission
        mission.start_mission()
        self.require(lambda: mission.mission_progress().current >= number, 60, f"item {number}")

    def watch_track(self, metres):
        items, place = self.mission.download_mission().mission_items, self.place()
        corners = [(*place.local(item.latitude_deg, item.longitude_deg), -item.relative_altitude_m) for item in items]
        self.telemetry.set_rate_position_velocity_ned(5.0)

        def watch(sample, *_):
            progress, at = self.mission.mission_progress(), sample.position
            if 0 < progress.current < progress.total:
                off = from_line((at.north_m, at.east_m, at.down_m), *corners[progress.current - 1:progress.current + 1])
                self.check(off < metres, f"{off:.2f} m beside the leg to item {progress.current}")

        self.telemetry.subscribe_position_velocity_ned(watch)

    def watch_speed(self, number, least):
        self.telemetry.set_rate_velocity_ned(10.0)

        def watch(velocity, *_):
            if self.mission.mission_progress().current == number:
                speed = math.hypot(velocity.north_m_s, velocity.east_m_s)
                self.check(speed > least, f"{speed:.2f} m/s to item {number}")

        self.telemetry.subscribe_velocity_ned(watch)

    def watch_altitude(self, within):
        wanted = self.position()[2]

        def watch(sample, *_):
            off = abs(sample.position.down_m - wanted)
            self.check(off <= within, f"{off:.2f} m beside the altitude")

        self.telemetry.subscribe_position_velocity_ned(watch)

    def sticks(self, seconds, pitch=0.0, roll=0.0, throttle=0.5, each=lambda: None, until=lambda: False):
        end = self.now() + seconds
        while self.now() < end and not until():
            each()
            self.manual.set_manual_control_input(pitch, roll, throttle, 0.0)
            self.sleep(0.02)


def succeeds(call, refusal):
    try:
        call()
        return True
    except refusal:
        return False
