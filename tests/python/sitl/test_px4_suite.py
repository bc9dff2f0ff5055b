"""PX4's own MAVSDK tests of multicopters (its test/mavsdk_tests), as they are: each flown in our words, with PX4's tolerances and
times. Left out are those of hexarotors, of several receivers or estimators, and of hills."""

import math
import random

import pytest
from mavsdk.plugins.failure.failure import FailureType, FailureUnit
from mavsdk.plugins.follow_me import Config, TargetLocation
from mavsdk.plugins.offboard import Attitude

from client import patiently
from px4_pilot import Pilot, Place, raw_item

# PX4's bits of COM_RCL_EXCEPT.
OFFBOARD = 4
RALLY_POINT = 5100
RALLY = 2


def takeoff_and_land(pilot):
    pilot.ready()
    pilot.take_off()
    pilot.action.land()
    pilot.disarmed(180)


def takeoff_and_hold(pilot):
    pilot.ready()
    pilot.store_home()
    pilot.take_off(10.0)
    pilot.require(lambda: abs(10 + pilot.position()[2]) <= 0.35, 30, "10 m")
    pilot.watch_altitude(0.25)
    pilot.sleep(60)


def square_that_returns(pilot):
    pilot.ready()
    pilot.square(back=True)
    pilot.arm()
    pilot.fly_mission()
    pilot.disarmed(180)


def mission_then_return(plan, **options):
    def fly(pilot):
        pilot.ready()
        getattr(pilot, plan)(**options)
        if plan == "straight":
            pilot.watch_speed(2, 4.0)
        pilot.watch_track(5.0)
        pilot.arm()
        pilot.fly_mission()
        pilot.airborne()
        pilot.action.return_to_launch()
        pilot.disarmed(180)

    return fly


def set_on_a_jump(pilot):
    """The current item is set to a DO_JUMP."""
    pilot.ready()
    at = pilot.place().globe
    pilot.raw.upload_mission([
        raw_item(0, 22, at(0, 0), 15.0), raw_item(1, 16, at(100, 0), 15.0), raw_item(2, 16, at(100, 100), 15.0),
        raw_item(3, 177, parameters=(1.0, 1.0)), raw_item(4, 16, at(0, 100), 15.0), raw_item(5, 21, at(0, 0))])
    pilot.sleep(1)
    pilot.arm()
    pilot.to_item(2, pilot.raw)
    pilot.raw.set_current_mission_item_async(3, lambda *_: None)
    pilot.disarmed(240)


def offboard_takeoff(pilot):
    pilot.ready()
    pilot.store_home()
    pilot.set(COM_RCL_EXCEPT=OFFBOARD)
    pilot.arm()
    pilot.goto(0, 0, -2, 0, seconds=90)
    pilot.offboard_land()
    pilot.disarmed(120)
    pilot.home_within(2.0)


def offboard_positions(pilot):
    pilot.ready()
    pilot.store_home()
    pilot.set(COM_RCL_EXCEPT=OFFBOARD)
    pilot.arm()
    for target in [(0, 0, -2, 0), (0, 5, -2, 180), (5, 5, -4, 180), (5, 0, -4, 90), (0, 0, -2, 0)]:
        pilot.goto(*target, seconds=10)
    pilot.offboard_land()
    pilot.disarmed(120)
    pilot.home_within(2.0)


def offboard_attitudes(pilot):
    telemetry, offboard = pilot.telemetry, pilot.offboard

    def hold(seconds, pitch, thrust, until=lambda: False):
        end = pilot.now() + seconds
        while pilot.now() < end and not until():
            offboard.set_attitude(Attitude(0.0, pitch, 0.0, thrust))
            pilot.sleep(0.02)

    def ellipsoid():
        return telemetry.raw_gps().altitude_ellipsoid_m

    def level():
        return max(abs(telemetry.attitude_euler().roll_deg), abs(telemetry.attitude_euler().pitch_deg)) < 5

    pilot.set(COM_RCL_EXCEPT=OFFBOARD)
    pilot.require(lambda: ellipsoid() > 0 and level(), 20, "GPS and attitude")
    start = ellipsoid()
    offboard.set_attitude(Attitude(0.0, 0.0, 0.0, 0.0))
    pilot.begin_offboard(lambda: offboard.set_attitude(Attitude(0.0, 0.0, 0.0, 0.0)))
    pilot.require(lambda: telemetry.health().is_armable, 20, "armable")
    pilot.arm()
    hold(30, 0.0, 0.8, until=lambda: ellipsoid() - start >= 10)
    hold(3, -20.0, 0.8)
    attitude = telemetry.attitude_euler()
    pilot.check(abs(attitude.roll_deg) < 5 and abs(attitude.pitch_deg + 20) < 5, str(attitude))
    hold(6, 0.0, 0.4)
    offboard.set_attitude(Attitude(0.0, 0.0, 0.0, 0.0))
    pilot.disarmed(120)


def by_hand(mode, armed_for):
    def fly(pilot):
        pilot.sticks(1)
        getattr(pilot.manual, f"start_{mode}_control")()
        pilot.sticks(1)
        pilot.store_home()
        pilot.sticks(1)
        pilot.ready()
        pilot.sticks(1)
        pilot.arm()
        pilot.sticks(armed_for)
        pilot.sticks(5, throttle=1.0)
        pilot.sticks(10, pitch=0.5)
        pilot.sticks(60, throttle=0.0, until=lambda: not pilot.telemetry.in_air())
        pilot.disarmed(180)
        pilot.home_not_within(5.0)

    return fly


def on_a_mission(unit, kind, reference=None, finishes=90, disarms=90):
    """A sensor fails on a mission: without GPS it lands, without the others it goes on."""
    def fly(pilot):
        if reference is not None:
            pilot.set(EKF2_HGT_REF=reference)
        pilot.ready()
        pilot.square(back=True)
        pilot.arm()
        pilot.set(SYS_FAILURE_EN=1)
        pilot.to_item(1)
        pilot.inject(unit, kind, 0)
        if finishes is not None:
            pilot.finish(finishes)
        pilot.disarmed(disarms)

    return fly


def injection_in_flight(pilot):
    pilot.ready()
    pilot.take_off()
    pilot.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 1, "DISABLED")
    pilot.action.return_to_launch()
    pilot.disarmed(180)


def injection_on_the_ground(pilot):
    pilot.ready()
    pilot.inject(FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 1, "DISABLED")


class Target:
    """It moves north with 2 m/s from where the vehicle is, and tells that with noise that is the same each time."""

    def __init__(self, pilot):
        self.at, self.home, self.moves = list(pilot.position()), pilot.home, 0
        self.place = Place(self.home.latitude_deg, self.home.longitude_deg)

    def move(self):
        self.at[0] += 2.0
        self.moves += 1

    def told(self, velocity):
        noise = random.Random(self.moves).gauss
        north, east, down = (part + noise(0.0, 1.0) for part in self.at)
        told = [(2.0 if axis == 0 and self.moves else 0.0) + noise(0.0, 0.1) for axis in range(3)] if velocity else [math.nan] * 3
        return TargetLocation(*self.place.globe(north, east), down + self.home.absolute_altitude_m, *told)


def follow_from(pilot):
    """Up at PX4's 10 m, and the target below."""
    pilot.ready()
    pilot.store_home()
    pilot.take_off(10.0)
    return Target(pilot)


def follow(velocity):
    """From behind, from ahead, and from both sides ahead, to 11 m along either axis."""
    turns = {5: 180.0, 20: 0.0, 35: 45.0, 55: -45.0}
    checks = [*range(15, 20), *range(30, 35), *range(45, 55), *range(65, 75)]

    def fly(pilot):
        target = follow_from(pilot)
        pilot.sleep(1)
        pilot.begin_to_follow()
        pilot.sleep(1)
        for second in range(75):
            there, here = tuple(target.at), pilot.position()
            if second in turns:
                angle = turns[second]
                pilot.follow.set_config(Config(10.0, 8.0, 0.1, Config.FollowAltitudeMode.CONSTANT, 15.0, angle))
            elif second > 5:
                target.move()
            if second in checks:
                wanted = [8 * part(math.radians(angle)) for part in (math.cos, math.sin)]
                off = [h - t - w for h, t, w in zip(here, there, wanted)]
                height = pilot.telemetry.position().relative_altitude_m
                pilot.check(max(map(abs, off)) < 11 and math.dist(here, there) <= 19, f"{second} s: {off} m from the place")
                pilot.check(abs(height - 10) <= 1.5, f"{second} s: {height} m up")
            pilot.follow.set_target_location(target.told(velocity))
            pilot.sleep(1)
        pilot.follow.stop()
        pilot.action.land()
        pilot.disarmed(300)

    return fly


def follow_nothing(pilot):
    """A velocity without a place tells nothing."""
    follow_from(pilot)
    pilot.follow.set_config(Config())
    pilot.sleep(1)
    pilot.begin_to_follow()
    pilot.sleep(1)
    began = pilot.position()
    for _ in range(15):
        pilot.follow.set_target_location(TargetLocation(math.nan, math.nan, math.nan, 2.0, 1.0, 0.5))
        pilot.sleep(1)
    pilot.check(math.dist(began, pilot.position()) < 4, f"moved from {began} to {pilot.position()}")
    pilot.action.land()
    pilot.disarmed(300)
    pilot.home_within(1.0)


def follow_by_sticks(pilot):
    """The throttle lifts the vehicle, the pitch stick takes it away from the target, the roll stick around it, half as much as the
    sticks ask for at least; around as far as 8 m/s and the pause take it."""
    target = follow_from(pilot)
    pilot.follow.set_config(Config(10.0, 10.0, 0.1, Config.FollowAltitudeMode.CONSTANT, 8.0, 0.0))
    north, east, down = target.at
    where = TargetLocation(*target.place.globe(north, east), down + target.home.absolute_altitude_m, 0.0, 0.0, 0.0)
    pilot.begin_to_follow()

    def stand(**sticks):
        pilot.sticks(3 if sticks else 5, each=lambda: pilot.follow.set_target_location(where), **sticks)
        if sticks:
            pilot.sticks(2, each=lambda: pilot.follow.set_target_location(where))
        return pilot.position()

    began = stand()
    risen = stand(throttle=1.0)
    pilot.check(began[2] - risen[2] > 1.5 * 3 / 2, f"from {began} to {risen}")
    away = stand(pitch=1.0)
    pilot.check(math.dist(away[:2], (north, east)) > 10 + 2.0 * 3 / 2, f"at {away}")
    around = stand(roll=1.0)
    turned = math.atan2(around[1] - east, around[0] - north)
    pilot.check(0.7 < turned, f"at {around}, {turned} rad")
    pilot.action.land()
    pilot.disarmed(300)


def return_to_the_nearest(rally=None, from_far=False):
    """RTL_TYPE 6."""
    def fly(pilot):
        pilot.ready()
        pilot.store_home()
        pilot.set(RTL_TYPE=6)
        if rally:
            pilot.raw.upload_rally_points([raw_item(0, RALLY_POINT, pilot.place().globe(*rally), kind=RALLY)])
        pilot.take_off()
        if from_far:
            pilot.goto(400, 0, -20, 0, within=5.0, seconds=60)
        pilot.action.return_to_launch()
        pilot.disarmed(150 if from_far else 90)
        if from_far:
            pilot.check(pilot.from_home(*rally) < 5, f"{pilot.from_home(*rally)} m from the rally point")
            pilot.home_not_within(20.0)
        else:
            pilot.home_within(5.0)

    return fly


GPS, MAG, BARO = FailureUnit.SENSOR_GPS, FailureUnit.SENSOR_MAG, FailureUnit.SENSOR_BARO
OFF, STUCK = FailureType.OFF, FailureType.STUCK
# With the speed of each: where MAVSDK sends set-points by the wall clock, they come often enough.
FLIGHTS = {
    "Takeoff and Land": (30, takeoff_and_land),
    "Takeoff and hold position": (30, takeoff_and_hold),
    "Fly square Multicopter Missions including RTL": (30, square_that_returns),
    "Fly square Multicopter Missions with manual RTL": (30, mission_then_return("square")),
    "Fly straight Multicopter Mission": (30, mission_then_return("straight", through=True)),
    "Mission with external set-current onto a DO_JUMP item": (30, set_on_a_jump),
    "Offboard takeoff and land": (10, offboard_takeoff),
    "Offboard position control": (10, offboard_positions),
    "Offboard attitude control": (10, offboard_attitudes),
    "Fly forward in position control": (10, by_hand("position", 0)),
    "Fly forward in altitude control": (10, by_hand("altitude", 1)),
    "Land on GPS lost during mission (baro height mode)": (20, on_a_mission(GPS, OFF, 0, None, 30)),
    "Land on GPS lost during mission (GPS height mode)": (20, on_a_mission(GPS, OFF, 1, None, 30)),
    "Continue on mag lost during mission": (20, on_a_mission(MAG, OFF, disarms=120)),
    "Continue on mag stuck during mission": (20, on_a_mission(MAG, STUCK, finishes=120)),
    "Continue on baro lost during mission (baro height mode)": (20, on_a_mission(BARO, OFF, 0)),
    "Continue on baro lost during mission (GPS height mode)": (20, on_a_mission(BARO, OFF, 1)),
    "Continue on baro stuck during mission (baro height mode)": (20, on_a_mission(BARO, STUCK, 0)),
    "Continue on baro stuck during mission (GPS height mode)": (20, on_a_mission(BARO, STUCK, 1)),
    "Failure Injection - Reject mid-air when it is disabled": (30, injection_in_flight),
    "Failure Injection - Reject before arming": (30, injection_on_the_ground),
    "Follow target - Position streaming": (3, follow(velocity=False)),
    "Follow target - Position and velocity streaming": (5, follow(velocity=True)),
    "Follow target - Velocity streaming only": (20, follow_nothing),
    "Follow target - RC Adjustment": (6, follow_by_sticks),
    "RTL_TYPE=6 with no rally points": (30, return_to_the_nearest()),
    "RTL_TYPE=6 with rally points and home is closest": (30, return_to_the_nearest((100.0, -100.0))),
    "RTL_TYPE=6 with rally points and home is not closest": (15, return_to_the_nearest((300.0, 0.0), from_far=True)),
}


@pytest.mark.parametrize("name", FLIGHTS)
def test_px4(fly, name):
    speed, flight = FLIGHTS[name]
    # A test on a busy machine is late with its takeoff, too, and the later the faster the vehicle's time.
    pilot = Pilot(fly(*patiently("--speed", str(speed), "--set", "COM_DISARM_PRFLT=-1")))
    flight(pilot)
    assert not pilot.wrong, f"{len(pilot.wrong)} times wrong, first and last: {pilot.wrong[:3]}, {pilot.wrong[-3:]}"
