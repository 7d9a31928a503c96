"""The campaign in one process, or on a local Dask cluster: python run.py 100000 [dask]"""

import sys
import time

import odkit
from network import scenario, start


def main(count, engine):
    began = time.perf_counter()
    if engine == "dask":
        from distributed import Client, LocalCluster

        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                client.upload_file("network.py")
                report(count, odkit.campaign(scenario, range(count), start(), map=client.map), began)
    else:
        report(count, odkit.campaign(scenario, range(count), start()), began)


def report(count, failures, began):
    failed = 0
    for failure in failures:
        failed += 1
        print(failure)
        print(failure.script if failure.shrunk is None else failure.shrunk)
    seconds = time.perf_counter() - began
    print(f"{count} scenarios in {seconds:.1f} s, {count / seconds:.0f} a second; {failed} failed")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000, sys.argv[2] if len(sys.argv) > 2 else "")
