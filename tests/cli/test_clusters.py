"""`mocap graph --cluster` and `--jobs`: the same graph, and one sentence where no cluster answers."""

import socket
import sys

import numpy as np
import pytest

import mocap
from mocap.cli import clusters
from mocap.graphs import storage


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    distributed = pytest.importorskip("distributed")
    options = {"processes": False, "dashboard_address": None, "protocol": "tcp"}
    options["local_directory"] = str(tmp_path_factory.mktemp("cluster"))
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, **options) as found:
        yield found


def arrays(path):
    with np.load(path) as archive:
        return {name: archive[name] for name in archive.files}


def test_a_cluster_gives_the_same_graph(clips, run, cluster):
    run("graph a.bvh b.bvh -o here.npz --threshold 5")
    told = run(f"graph a.bvh b.bvh -o there.npz --threshold 5 --cluster {cluster.scheduler_address}")
    assert told.out.splitlines()[-1] == "wrote        there.npz" and told.err == ""
    here, there = (arrays(clips / name) for name in ("here.npz", "there.npz"))
    assert here.keys() == there.keys()
    for name, values in here.items():
        np.testing.assert_array_equal(values, there[name], err_msg=name)
    assert storage.read(clips / "there.npz").graph.number_of_edges() > 0


@pytest.mark.parametrize(
    "address", ["nowhere", "8786", "tcp://", "tcp://host:port", "http://a:1", "tcp://a b:1"]
)
def test_an_address_that_is_none_is_refused_before_anything_is_read(clips, run, address):
    told = run(f"graph a.bvh -o g.npz --cluster '{address}'", 2).err
    assert told.count("\n") == 1 and "Write tcp://HOST:PORT, as dask prints it" in told
    assert not (clips / "g.npz").exists()


def test_without_distributed_the_extra_is_named(clips, run, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    told = run("graph a.bvh -o g.npz --cluster tcp://localhost:8786", 2).err
    assert "A cluster needs distributed: pip install" in told and "[distributed]" in told


def test_a_scheduler_that_does_not_answer_is_refused(clips, run, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(clusters, "PATIENCE", 0.3)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    told = run(f"graph a.bvh -o g.npz --cluster tcp://127.0.0.1:{port}", 2).err
    assert told.count("\n") == 1 and f"No scheduler answers at tcp://127.0.0.1:{port} within 0.3 s" in told


def test_a_scheduler_without_workers_is_refused(clips, run, monkeypatch, tmp_path):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(clusters, "PATIENCE", 0.5)
    options = {"processes": False, "dashboard_address": None, "protocol": "tcp"}
    options["local_directory"] = str(tmp_path)
    with distributed.LocalCluster(n_workers=0, **options) as empty:
        told = run(f"graph a.bvh -o g.npz --cluster {empty.scheduler_address}", 2).err
    assert told.count("\n") == 1 and "has no workers: start some by `dask worker tcp://" in told


def test_workers_of_another_version_are_refused(clips, run, monkeypatch, cluster):
    monkeypatch.setattr(clusters, "_version_reader", lambda: lambda: "0.1.0")
    told = run(f"graph a.bvh -o g.npz --cluster {cluster.scheduler_address}", 2).err
    assert f"have mocap 0.1.0: install {mocap.__version__} there" in told


def test_threads_give_the_same_graph(clips, run):
    run("graph a.bvh b.bvh -o one.npz --threshold 5 --jobs 1")
    run("graph a.bvh b.bvh -o three.npz --threshold 5 --jobs 3")
    one, three = (arrays(clips / name) for name in ("one.npz", "three.npz"))
    for name, values in one.items():
        np.testing.assert_array_equal(values, three[name], err_msg=name)
