"""The live page in a headless Chromium. The oracle is telemetry over MAVLink, and a projection of our own."""

import json
import math
import socket

import numpy as np
import pytest
from client import near
from plans import waypoints

pytestmark = pytest.mark.browser

SIZES = [(400, 800), (1280, 800), (3840, 2160)]


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def host(url: str) -> str:
    return url.split("//")[1].split("/")[0]


def test_it_draws_the_vehicle_where_telemetry_says_and_a_click_flies_it_there(start, connect, look):
    vehicle = start("--view", "127.0.0.1:0")
    client = connect(vehicle)
    shown = look(vehicle.ready["view"])
    page = shown.page
    shown.wait("page.isPilot && page.frame?.vehicles.length === 1")
    assert page.locator("#connection").inner_text() == "live"
    no_set_point = page.locator("figure", has_text="Tracking error").get_by_text("No set-point", exact=True)
    page.locator("#charts").scroll_into_view_if_needed()
    no_set_point.wait_for()
    page.get_by_role("button", name="Take off").click()
    client.wait("LOCAL_POSITION_NED", near((0, 0, -5), within=0.2), timeout=30)
    assert page.locator("#answer").inner_text() == "take off: accepted"
    no_set_point.wait_for(state="hidden")
    assert page.locator("#charts figure.empty").count() == 0
    # Vehicles introduce themselves to whoever gives the first command, too, but the page has heard it.
    assert page.locator("#texts li", has_text="simulated quadrotor").count() == 1

    page.get_by_role("button", name="Follow").click()  # the view stands still from now on
    goal = (4.0, -3.0, -5.0)
    page.mouse.click(*shown.project(goal))
    client.wait("LOCAL_POSITION_NED", near(goal, within=0.15), timeout=40)
    at = client.wait("LOCAL_POSITION_NED")
    shown.wait("Math.hypot(...page.frame.vehicles[0].velocity) < 0.05")
    drawn = shown.value("page.frame.vehicles[0].position")
    assert drawn == pytest.approx((at.x, at.y, at.z), abs=0.05)
    # Its body is where the place is on the screen, and not where it was.
    assert shown.dark_pixels(shown.project(drawn)) > 25
    assert shown.dark_pixels(shown.project((0, 0, -5))) < 12
    # Nothing came from another host.
    assert {host(url) for url in shown.requests} == {host(vehicle.ready["view"])}

    page.get_by_role("button", name="Set wind").click()
    page.get_by_text("wind: accepted").wait_for()
    page.get_by_label("Fault").select_option("off")
    page.get_by_label("Unit").select_option("rotor2")
    page.get_by_role("button", name="Inject").click()
    shown.wait("page.news.vehicles[0].faults.includes('rotor2=off')")


def test_time_stands_goes_by_steps_and_runs_by_keys(start, look):
    vehicle = start("--view", "127.0.0.1:0")
    shown = look(vehicle.ready["view"])
    shown.wait("page.isPilot && page.frame")
    shown.page.locator("#view").focus()
    shown.page.keyboard.press(" ")
    shown.wait("page.frame.speed === 0")
    stood = shown.value("page.frame.time")
    shown.page.keyboard.press(".")
    shown.wait(f"Math.abs(page.frame.time - {stood} - 0.1) < 0.0015")
    assert shown.page.get_by_role("button", name="Pause").get_attribute("aria-pressed") == "true"
    shown.page.get_by_label("Speed").select_option("5")
    shown.wait(f"page.frame.speed === 5 && page.frame.time > {stood} + 1")
    shown.page.locator("#view").focus()
    shown.page.keyboard.press("t")
    shown.wait("page.frame.vehicles[0].position[2] < -4.8")
    shown.page.keyboard.press("l")
    shown.wait("page.frame.vehicles[0].landed && !page.frame.vehicles[0].armed")
    shown.page.get_by_text("Disarmed after landing").wait_for()


def test_who_has_no_token_only_looks_on(start, look):
    vehicle = start("--view", "127.0.0.1:0")
    pilot = look(vehicle.ready["view"])
    guest = look(vehicle.ready["view"].split("#")[0])
    for shown in (pilot, guest):
        shown.wait("page.frame")
    pilot.wait("page.isPilot")
    assert guest.page.get_by_text("View only").is_visible() and not pilot.page.get_by_text("View only").is_visible()
    assert guest.page.get_by_role("button", name="Take off").is_disabled()
    assert "token" in guest.page.evaluate("() => window.lmpcView.page.stream.ask(1, 'arm')")
    pilot.page.get_by_role("button", name="Arm", exact=True).click()
    for shown in (pilot, guest):
        shown.wait("page.frame.vehicles[0].armed")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_every_screen_in_light_and_dark(start, look, scheme):
    vehicle = start("--view", "127.0.0.1:0")
    pages = [look(vehicle.ready["view"], size=size, scheme=scheme) for size in SIZES]
    for shown, size in zip(pages, SIZES):
        shown.wait("page.isPilot && page.frame")
        assert shown.page.evaluate("() => document.documentElement.scrollWidth") <= size[0]
        background = shown.page.evaluate("() => getComputedStyle(document.body).backgroundColor")
        levels = [int(level) for level in background[4:-1].split(",")]
        assert (np.mean(levels) > 200) == (scheme == "light"), background
        for part in ("#view", "#horizon", "#state", "#charts figure"):
            box = shown.page.locator(part).first.bounding_box()
            assert box["width"] > 100 and box["height"] > 80, (size, part, box)
        # A number with its sign and decimals is read at a glance: none of it is cut off.
        for name in ("north", "east"):
            field = shown.page.locator(f"#fly-to input[name={name}]")
            field.fill("-1234.56")
            room, needed = field.evaluate("""(field) => {
                const style = getComputedStyle(field), ink = document.createElement("canvas").getContext("2d");
                ink.font = style.font;
                const spinner = style.appearance === "textfield" ? 0 : 16;
                return [field.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight) - spinner, ink.measureText(field.value).width];
            }""")
            assert room > needed, (size, name, room, needed)


def test_every_control_has_a_name_and_is_reached_by_keys(start, look):
    vehicle = start("--view", "127.0.0.1:0", "--vehicles", "2", "--ports", "shared")
    shown = look(vehicle.ready["view"])
    shown.wait("page.isPilot && page.frame?.vehicles.length === 2")
    names = shown.page.evaluate("""() => [...document.querySelectorAll("button, input, select, canvas, section")].filter((part) => part.checkVisibility() && !part.closest("figure"))
        .map((part) => [part.outerHTML.slice(0, 60), part.ariaLabel || part.labels?.[0]?.textContent.trim() || part.textContent.trim()])""")
    assert len(names) > 25 and not [part for part, name in names if not name]
    reached = set()
    for _ in range(60):
        shown.page.keyboard.press("Tab")
        reached.add(shown.page.evaluate("() => document.activeElement.id || document.activeElement.dataset.action || document.activeElement.name"))
    for form in ("Fly to a place", "Wind", "Failure"):
        assert shown.page.get_by_role("form", name=form).is_visible(), form
    # The legends of the plots have values for a mouse only.
    assert shown.page.get_by_role("table").count() == 0
    for vehicle_number in (1, 2):
        shown.page.get_by_text(f"vehicle {vehicle_number}: lmpc-sitl").first.wait_for()
    assert {"pause", "step", "speed", "file", "view", "follow", "vehicle", "arm", "land", "north", "kind"} <= reached
    shown.page.locator("#view").focus()
    shown.page.keyboard.press("2")
    shown.wait("page.chosen === 2")
    assert shown.page.get_by_role("radio", name="Vehicle 2").is_checked()
    angle = "Math.atan2(view.camera.position.x - view.controls.target.x, view.camera.position.z - view.controls.target.z)"
    before = shown.value(angle)
    shown.page.keyboard.press("ArrowRight")
    shown.wait(f"Math.abs({angle} - {before}) > 0.05")


def test_ten_vehicles_are_where_they_stand_and_are_drawn_at_once_and_only_when_they_move(start, look):
    vehicle = start("--view", "127.0.0.1:0", "--vehicles", "10", "--formation", "line,5", "--ports", "shared")
    shown = look(vehicle.ready["view"])
    shown.wait("page.isPilot && page.frame?.vehicles.length === 10")
    shown.page.get_by_role("button", name="Show all").click()
    shown.wait("document.querySelectorAll('#labels .vehicle').length === 10")
    assert shown.page.get_by_text("Squares of 10 m").is_visible()
    for state in shown.value("page.frame.vehicles"):
        assert shown.dark_pixels(shown.project(state["position"])) > 12, state["id"]
    # Bodies, discs, shadows, lines and set-points of all, a grid in three parts, and for each a trail and its home.
    assert shown.value("view.renderer.info.render.calls") <= 10 + 2 * 10
    shown.page.get_by_role("button", name="Pause").click()
    shown.wait("page.frame.speed === 0 && page.frame.pace === 0")
    # What was asked for before has been drawn after two pictures of the browser.
    drawn = shown.page.evaluate("""async () => {
        const { renderer } = window.lmpcView.view;
        const picture = () => new Promise(requestAnimationFrame);
        await picture(); await picture();
        const before = renderer.info.render.frame;
        for (let count = 0; count < 30; count += 1) await picture();
        return renderer.info.render.frame - before;
    }""")
    assert drawn == 0


def test_pixels_become_coarser_where_drawing_is_slow_and_fine_again(start, look):
    vehicle = start("--view", "127.0.0.1:0")
    shown = look(vehicle.ready["view"])
    shown.wait("page.frame")
    ratios = shown.page.evaluate("""async () => {
        const { Fineness } = await import("/page/graphics.js");
        const fineness = new Fineness(false), ratios = [];
        let now = 0;
        const draw = (waited, seconds) => {
            for (const end = now + 1000 * seconds; now < end; now += waited) fineness.take(waited, now);
            ratios.push(fineness.ratio(800, 500));
        };
        draw(17, 10); draw(60, 3); draw(60, 30); draw(17, 10); draw(17, 30); draw(17, 60);
        return [...ratios, new Fineness(true).ratio(2400, 1400)];
    }""")
    fine, first, coarsest, still, finer, finest, large = ratios
    assert fine == 1 and first == 0.75 and coarsest == 0.5 and still == coarsest and coarsest < finer <= 1 and finest == 1
    # A program draws no more pixels than it can.
    assert 0.4 < large < 0.6


def test_missions_and_fences_are_drawn_where_they_are(start, look, tmp_path):
    vehicle = start("--view", "127.0.0.1:0", "--mission", waypoints(tmp_path, (20, 0, 8)), "--set", "GF_MAX_HOR_DIST=40", "--set", "GF_ACTION=1")
    shown = look(vehicle.ready["view"])
    shown.wait("page.scene.vehicles[0]?.mission.length > 0 && page.scene.vehicles[0].fence")
    last = shown.value("page.scene.vehicles[0].mission.at(-1).position_m")
    assert last == pytest.approx((20, 0, -8), abs=0.05)
    fence = shown.value("page.scene.vehicles[0].fence")
    assert fence["radius_m"] == 40 and fence["zones"] == []
    shown.page.get_by_role("button", name="Show all").click()
    shown.wait("[...document.querySelectorAll('#labels .waypoint')].some((label) => !label.hidden)")
    expected = shown.project(last)
    stage = shown.page.locator("#stage").bounding_box()
    box = shown.page.locator("#labels .waypoint").last.bounding_box()
    assert math.dist((box["x"], box["y"]), expected) < 30, (box, expected, stage)


def test_a_camera_beyond_a_fence_looks_through_its_wall(start, look, tmp_path):
    """The oracle is the sky's own colour: a wall between it and the camera would tint it."""
    degree = math.degrees(1 / 6_371_000.0)
    start_at = (47.397742, 8.545594)
    corners = [[start_at[0] + 8 * n * degree, start_at[1] + 8 * e * degree / math.cos(math.radians(start_at[0]))] for n, e in ((0, 0), (2, 0), (2, 2), (0, 2))]
    plan = {"fileType": "Plan", "version": 1, "groundStation": "test", "rallyPoints": {"version": 2, "points": []},
            "mission": {"version": 2, "firmwareType": 12, "vehicleType": 2, "cruiseSpeed": 5, "hoverSpeed": 5, "items": [], "plannedHomePosition": [*start_at, 488]},
            "geoFence": {"version": 2, "circles": [], "polygons": []}}
    colours = {}
    for keeps_in in (True, False):
        for turned in (False, True):
            zone = {"polygon": corners[::-1] if turned else corners, "inclusion": keeps_in, "version": 1}
            (tmp_path / "fence.plan").write_text(json.dumps({**plan, "geoFence": {**plan["geoFence"], "polygons": [zone]}}))
            vehicle = start("--view", "127.0.0.1:0", "--mission", str(tmp_path / "fence.plan"))
            shown = look(vehicle.ready["view"])
            shown.wait("page.scene.vehicles[0]?.fence?.zones.length === 1 && page.frame")
            shown.page.get_by_role("button", name="Follow").click()
            shown.fine()
            # In the middle of the zone, and just west of it: steeply up, through one wall of 30 m.
            for inside, east, slope in ((True, 8, 1), (False, -2, 12)):
                at, aim = [east, 3, -8], [east + 1, 3 + slope, -8]
                colours[keeps_in, turned, inside] = shown.page.evaluate("""async ([at, aim]) => {
                    const { view } = window.lmpcView;
                    view.camera.position.set(...at);
                    view.camera.lookAt(...aim);
                    view.renderer.clear();
                    view.renderer.render(view.scene, view.camera);
                    const gl = view.renderer.getContext(), pixel = new Uint8Array(4);
                    gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
                    return [...pixel.slice(0, 3)];
                }""", [at, aim])
    sky = colours[False, False, True]
    for (keeps_in, _, inside), colour in colours.items():
        assert (colour != sky) == (keeps_in == inside), colours


HILL = "[[hill]]\ncenter = [20.0, 0.0]\nradius = 15.0\ntop = 3.0\nheight = 6.0\n"


def test_hills_are_drawn_as_high_as_they_are(start, connect, look, tmp_path):
    """The oracle is the hill's formula: half a wave of a cosine from its level top to its foot."""
    world = tmp_path / "world.toml"
    world.write_text(f"{HILL}[[cylinder]]\ncenter = [-9.0, -9.0]\nradius = 1.0\nheight = 8.0\n")
    vehicle = start("--view", "127.0.0.1:0", "--world", str(world))
    shown = look(vehicle.ready["view"])
    shown.wait("page.scene.ground && page.frame")
    surface = "view.surroundings.group.children.flatMap(({ children }) => children).find(({ isMesh }) => isMesh)"
    corners = np.array(shown.value(f"[...{surface}.geometry.attributes.position.array]")).reshape(-1, 3)
    east, up, south = corners.T
    away = np.clip((np.hypot(-south - 20, east) - 3) / 12, 0, 1)
    assert len(corners) < 10_300 and up == pytest.approx(3 * (1 + np.cos(np.pi * away)), abs=0.0051)
    assert min(east) < -20 and max(east) > 20 and min(-south) < 0 and max(-south) > 40
    assert shown.page.locator("#scale").inner_text() == "Squares of 1 m"
    # An obstacle stands on the ground, and not in it.
    assert shown.value("page.scene.obstacles[0].heights_m") == pytest.approx((0, 8), abs=0.001)
    # A vehicle over the hill has its shadow on it.
    client = connect(vehicle)
    client.take_off()
    client.go(lambda: client.position((0, 0, -10)))
    for goal in ((0, 0, -10), (20, 0, -10)):
        client.stream(lambda: client.position(goal), near(goal, within=0.2))
    shown.wait("Math.abs(view.crafts.drops.geometry.attributes.position.getY(1) - 6) < 0.05")


def hill(north, east):
    """Its height by its formula, m."""
    return 3 * (1 + math.cos(math.pi * min(max((math.hypot(north - 20, east) - 3) / 12, 0), 1)))


def test_a_click_on_a_slope_flies_over_that_place(start, connect, look, tmp_path):
    """The place on the screen is projected by the test. A plane at the height of the form is metres beside it there."""
    world = tmp_path / "world.toml"
    world.write_text(HILL)
    vehicle = start("--view", "127.0.0.1:0", "--world", str(world))
    client = connect(vehicle)
    shown = look(vehicle.ready["view"])
    shown.wait("page.isPilot && page.scene.ground && page.frame")
    shown.page.get_by_role("button", name="Take off").click()
    client.wait("LOCAL_POSITION_NED", near((0, 0, -5), within=0.2), timeout=30)
    shown.page.get_by_role("button", name="Follow").click()
    for north, east in ((11.0, -2.0), (20.0, 0.0), (-200.0, 30.0)):
        shown.page.evaluate("""([north, east]) => {
            const { view } = window.lmpcView;
            view.controls.target.set(east, 4, -north);
            view.lookFrom(view.camera.position.clone().set(8, 7, 20));
        }""", [north, east])
        seen = shown.value("page.frame.time")
        shown.wait(f"page.frame.time > {seen}")
        shown.page.mouse.click(*shown.project((north, east, -hill(north, east))))
        asked = [float(shown.page.locator(f"#fly-to [name={name}]").input_value()) for name in ("north", "east")]
        assert asked == pytest.approx((north, east), abs=0.15)
        if north > 0:
            client.wait("LOCAL_POSITION_NED", near((*asked, -hill(*asked) - 5), within=0.15), timeout=40)


def test_a_mission_over_a_hill_is_drawn_as_it_is_flown(start, connect, look, tmp_path):
    """The oracle is the flight: its trail keeps to the line, 4 m above the ground, and the line to the trail."""
    world, plan = tmp_path / "world.toml", tmp_path / "hill.waypoints"
    world.write_text(HILL)
    lines = ["QGC WPL 110"] + [
        f"{item}\t0\t{frame}\t{command}\t2\t0\t0\t0\t{47.397742 + math.degrees(north / 6_371_000.0)}\t8.545594\t{height}\t1"
        for item, (frame, command, north, height) in enumerate([(0, 16, 0, 488), (3, 22, 0, 4), (10, 16, 40, 4)])
    ]
    plan.write_text("\n".join(lines) + "\n")
    vehicle = start("--view", "127.0.0.1:0", "--world", str(world), "--mission", str(plan), "--speed", "5")
    client = connect(vehicle)
    shown = look(vehicle.ready["view"])
    shown.wait("page.isPilot && page.scene.vehicles[0]?.mission.length === 2")
    positions = "view.surroundings.group.children.find(({ isLine, material }) => isLine && material.isLineDashedMaterial).geometry.attributes.position.array"
    east, up, south = np.array(shown.value(f"[...{positions}]")).reshape(-1, 3).T
    assert max(abs(east)) < 0.05 and len(up) > 10
    expected = [4 + hill(north, 0) for north in -south]
    assert up[1:] == pytest.approx(expected[1:], abs=0.05) and up[0] == pytest.approx(0, abs=0.01)
    shown.page.get_by_role("button", name="Start mission").click()
    client.wait("LOCAL_POSITION_NED", near((40, 0, -4), within=0.2), timeout=60)
    trail = np.array(shown.value("page.histories.get(1).places"))
    on_the_way = [(north, -down) for north, _, down in trail if -down > 3.9]
    assert len(on_the_way) > 20 and max(height for _, height in on_the_way) == pytest.approx(10, abs=0.3)
    for north, height in on_the_way:
        assert height == pytest.approx(np.interp(north, -south[1:], up[1:]), abs=0.3), north


def test_the_page_finds_a_program_that_was_started_again(start, look):
    port = free_port()
    first = start("--view", f"127.0.0.1:{port}")
    shown = look(first.ready["view"], expected=["ERR_CONNECTION_REFUSED"])
    shown.wait("page.isPilot && page.frame")
    shown.page.get_by_role("button", name="Hold").click()
    shown.page.get_by_text("hold: ").wait_for()
    assert first.stop() == 0
    shown.page.get_by_text("connection lost, trying again").wait_for()
    # What the first program has answered is not what the second one does.
    assert shown.page.locator("#answer").inner_text() == ""
    assert shown.page.get_by_role("button", name="Take off").is_disabled()
    start("--view", f"127.0.0.1:{port}")
    # The token is another: it shows the new flight, and says why it cannot steer it.
    shown.page.get_by_text("The token is from another run").wait_for()
    shown.wait("page.connection.state === 'live' && page.frame.time < 30")
