"""The MAVLink vehicle: speed, memory, start, latency, and cost against the numbers of vehicles and clients."""

import importlib.util
import os
import resource
import statistics
import subprocess
import tempfile
import time
from pathlib import Path


def measures(root: Path):
    """The measurements of sitl/measure.py."""
    spec = importlib.util.spec_from_file_location("measure", root / "sitl" / "measure.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def processor_time(arguments: list, seconds: float) -> float:
    """Seconds of processor time per simulated second of a run as fast as it goes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([*arguments, "--speed", "max", "--duration", str(seconds)], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / seconds


def resident(program: Path, vehicles: int) -> float:
    """Bytes of a process with so many vehicles, when it says that it is ready."""
    with tempfile.TemporaryDirectory() as folder:
        ready = Path(folder) / "ready"
        process = subprocess.Popen([program, "--link", "tcpin:0", "--vehicles", str(vehicles), "--ready-file", ready],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while not ready.exists():
                if process.poll() is not None:
                    raise SystemExit(f"{program} did not start")
                time.sleep(0.01)
            return int(Path(f"/proc/{process.pid}/status").read_text().split("VmRSS:")[1].split()[0]) * 1024
        finally:
            process.terminate()
            process.wait()


def growth(program: Path, quick: bool) -> list[dict]:
    seconds = 10 if quick else 60
    vehicles = [(count, processor_time([program, "--link", "tcpin:0", "--vehicles", str(count)], seconds))
                for count in ((1, 5, 20) if quick else (1, 2, 5, 10, 20, 50, 100))]
    # Nobody listens at these ports: what is sent is dropped by the system.
    links = [[f"udpout:127.0.0.1:{9 + number}" for number in range(count)] for count in ((1, 2, 4) if quick else (1, 2, 4, 8, 16))]
    clients = [(len(each), processor_time([program, *(part for link in each for part in ("--link", link))], seconds)) for each in links]
    return [{"against": name, "unit": "s of processor time per simulated second", "points": [{"size": a, "cost": b} for a, b in points]}
            for name, points in (("vehicles in one process", vehicles), ("links of one vehicle", clients))]


def measure(root: Path, program: Path, quick: bool) -> dict:
    module = measures(root)
    beats, armable = module.starts(program, 5 if quick else 20)
    alone = [module.highest_speed(program, ["--link", "tcpin:0"]) for _ in range(1 if quick else 3)]
    two = [module.highest_speed(program, ["--link", "udpout:127.0.0.1:9", "--link", "udpout:127.0.0.1:10,onboard"])
           for _ in range(1 if quick else 3)]
    one, several = resident(program, 1), resident(program, 50)
    figures = {
        "first_heartbeat_ms": statistics.median(beats),
        "armable_ms": statistics.median(armable),
        "armable_worst_ms": max(armable),
        "speed_alone": statistics.median(alone),
        "speed_two_links": statistics.median(two),
        "memory_bytes": one,
        "memory_per_vehicle_bytes": (several - one) / 49,
        "program_bytes": os.path.getsize(program),
    }
    if not quick:
        thrust, place = module.thrust_latencies(program, 30), module.position_latencies(program, 15)
        figures["thrust_to_motors_ms"] = {"median": statistics.median(thrust), "most": max(thrust), "period_ms": 10}
        figures["position_to_motors_ms"] = {"median": statistics.median(place), "most": max(place), "period_ms": 50}
    return figures
