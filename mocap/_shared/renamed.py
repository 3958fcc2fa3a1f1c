"""Names that earlier versions had, with their new names, for programs and copies of the course made by these.

The tables hold what notebooks of the course called and what has a successor. The old names do not work: the
error for an old name says the new one in a sentence.
"""

import sys
from importlib.abc import MetaPathFinder

MODULES = {
    "mocap.checks": "mocap.course.checks",
    "mocap.cloud_grid": "mocap.matching",
    "mocap.cmu": "mocap.datasets",
    "mocap.compiling": "mocap.graphs",
    "mocap.control": "mocap.steering",
    "mocap.crowd": "mocap.steering",
    "mocap.diagrams": "mocap.course.diagrams",
    "mocap.dumping": "mocap.synthesis",
    "mocap.follow": "mocap.steering",
    "mocap.footprints": "mocap.feet",
    "mocap.footskate": "mocap.feet",
    "mocap.graph_files": "mocap.graphs",
    "mocap.graph_summary": "mocap.graphs",
    "mocap.groups": "mocap.methods.groups",
    "mocap.inspection": "mocap.quality",
    "mocap.joining": "mocap.blending",
    "mocap.keyframes": "mocap.steering",
    "mocap.kinematics": "mocap.body.kinematics",
    "mocap.lab": "mocap.course.lab",
    "mocap.layered_search": "mocap.steering",
    "mocap.legs": "mocap.body",
    "mocap.match_webs": "mocap.methods.match_webs",
    "mocap.merging": "mocap.graphs",
    "mocap.methods.motion_matching.springs": "mocap.methods.motion_matching.nearest_frames",
    "mocap.minima": "mocap.matching",
    "mocap.motion": "mocap.body",
    "mocap.motion_graph": "mocap.graphs",
    "mocap.motion_matching": "mocap.methods.motion_matching",
    "mocap.paper_search": "mocap.steering",
    "mocap.parametric_graphs": "mocap.methods.parametric_graphs",
    "mocap.path_files": "mocap.files",
    "mocap.paths": "mocap.body",
    "mocap.plants": "mocap.feet",
    "mocap.point_clouds": "mocap.matching",
    "mocap.pruning": "mocap.graphs",
    "mocap.rotations": "mocap.body.rotations",
    "mocap.routes": "mocap.steering",
    "mocap.search": "mocap.synthesis",
    "mocap.segment_graph": "mocap.graphs.homework_graph",
    "mocap.stage": "mocap.plotting",
    "mocap.style": "mocap.plotting",
    "mocap.synthetic": "mocap.datasets",
    "mocap.thresholds": "mocap.graphs",
    "mocap.transforms": "mocap.body",
    "mocap.transitions": "mocap.matching",
    "mocap.variants": "mocap.editing",
    "mocap.walks": "mocap.synthesis",
}
"""Old names of modules, and the rooms or files that have their functions now."""

NAMES = {
    "mocap.blending.Course": "mocap.blending.mixing.Course",
    "mocap.blending.Curve": "mocap.blending.timewarps.Curve",
    "mocap.blending.fit_curve": "mocap.blending.timewarps.fit_curve",
    "mocap.blending.lay_window_on": "mocap.blending.align_window",
    "mocap.blending.window_steps": "mocap.blending.weights.window_steps",
    "mocap.body.lay_on": "mocap.body.planar.align_frames",
    "mocap.body.letter_s": "mocap.body.ground_path.letter_s",
    "mocap.body.require_alike": "mocap.body.concatenation.require_compatible",
    "mocap.course.checks.cheapest_way": "mocap.course.checks.cheapest_walk",
    "mocap.course.checks.mixed_way": "mocap.course.checks.mixed_trajectory",
    "mocap.course.diagrams.layer_step": "mocap.course.diagrams.layer_steps",
    "mocap.course.diagrams.products": "mocap.course.diagrams.turning",
    "mocap.course.diagrams.tarjan_step": "mocap.course.diagrams.tarjan_steps",
    "mocap.course.lab.class_curve": "mocap.course.lab.sensitivity.class_curve",
    "mocap.course.lab.d_prime": "mocap.course.lab.sensitivity.d_prime",
    "mocap.course.lab.read_answers": "mocap.course.lab.sensitivity.read_answers",
    "mocap.editing.Basis": "mocap.editing.Stage",
    "mocap.editing.roles": "mocap.body.limbs.roles",
    "mocap.graphs.Segment": "mocap.graphs.homework_graph.Segment",
    "mocap.graphs.connect": "mocap.graphs.homework_graph.connect",
    "mocap.graphs.edge_table": "mocap.graphs.edge_tables.edge_table",
    "mocap.graphs.labels_between": "mocap.graphs.motion_graph.labels_between",
    "mocap.graphs.largest_component": "mocap.graphs.components.largest_component",
    "mocap.graphs.merge_choice_points": "mocap.graphs.motion_graph.merge_choice_points",
    "mocap.graphs.numbered_edges": "mocap.graphs.components.numbered_edges",
    "mocap.graphs.reached": "mocap.graphs.components.reached",
    "mocap.graphs.require_node": "mocap.graphs.edge_tables.require_node",
    "mocap.graphs.segment_distances": "mocap.graphs.homework_graph.segment_distances",
    "mocap.graphs.segment_graph": "mocap.graphs.homework_graph.segment_graph",
    "mocap.graphs.segment_motion": "mocap.graphs.homework_graph.segment_motion",
    "mocap.graphs.segment_walk": "mocap.graphs.homework_graph.segment_walk",
    "mocap.graphs.segments": "mocap.graphs.homework_graph.segments",
    "mocap.graphs.smallest_threshold": "mocap.graphs.thresholds.smallest_threshold",
    "mocap.graphs.velocity_gaps": "mocap.graphs.thresholds.velocity_differences",
    "mocap.graphs.velocity_jumps": "mocap.graphs.thresholds.velocity_differences",
    "mocap.graphs.write_graphml": "mocap.graphs.graph_summary.write_graphml",
    "mocap.matching.cloud": "mocap.matching.prepared_clouds.cloud",
    "mocap.matching.euler_grid": "mocap.matching.other_metrics.euler_grid",
    "mocap.matching.file_angles": "mocap.matching.other_metrics.file_angles",
    "mocap.matching.principal_directions": "mocap.matching.lower_bound.principal_directions",
    "mocap.matching.rms_distance": "mocap.matching.point_clouds.rms_distance",
    "mocap.matching.root_grid": "mocap.matching.other_metrics.root_grid",
    "mocap.matching.unit_weights": "mocap.matching.point_clouds.unit_weights",
    "mocap.methods.groups.GroupClip": "mocap.methods.groups.group_clips.GroupClip",
    "mocap.methods.match_webs.random_weights": "mocap.methods.match_webs.motion_spaces.random_weights",
    "mocap.methods.match_webs.turn": "mocap.methods.match_webs.heading_change",
    "mocap.methods.parametric_graphs.mixed_way": "mocap.methods.parametric_graphs.mixed_trajectory",
    "mocap.plain.lay": "mocap.plain.transform_clip",
    "mocap.plain.lay_on": "mocap.plain.align_start",
    "mocap.plain.product": "mocap.plain.compose",
    "mocap.plotting.bodies_along": "mocap.plotting.bodies.bodies_along",
    "mocap.plotting.stage": "mocap.plotting.ground_axes",
    "mocap.plotting.to_picture": "mocap.plotting.stick_figures.to_picture",
    "mocap.quality.ground_slides": "mocap.quality.seam_measures.sliding_per_frame",
    "mocap.quality.judgement_table": "mocap.quality.judging.judgement_table",
    "mocap.quality.knee_turns": "mocap.quality.knee_rotations",
    "mocap.quality.plant_slides": "mocap.quality.foot_sliding",
    "mocap.steering.States": "mocap.steering.layered_search.States",
    "mocap.steering.Wishes": "mocap.steering.PathRequest",
    "mocap.steering.select": "mocap.steering.layered_search.select",
    "mocap.synthesis.Branch": "mocap.synthesis.bounded_search.Branch",
    "mocap.synthesis.GroundWalks": "mocap.synthesis.ground_walks.GroundWalks",
    "mocap.synthesis.children": "mocap.synthesis.bounded_search.children",
    "mocap.synthesis.dump": "mocap.synthesis.random_walks.dump",
    "mocap.synthesis.stream": "mocap.synthesis.random_walks.stream",
}
"""Old names of functions and classes, and their new ones."""


def new_name(room: str, name: str) -> str:
    """Return the name that a module or a function has today; "" for a name that no earlier version had.

    Parameters
    ----------
    room : the module in which it was, such as mocap.plain.
    name : the name of old.

    Examples
    --------
    >>> new_name("mocap.plain", "lay"), new_name("mocap", "lab"), new_name("mocap", "lod")
    ('mocap.plain.transform_clip', 'mocap.course.lab', '')
    """
    old = f"{room}.{name}"
    return NAMES.get(old) or MODULES.get(old, "")


def sentence(room: str, name: str) -> str:
    """Return the error message for an old name; "" for a name that no earlier version had.

    Parameters
    ----------
    room, name : as for `new_name`.

    Examples
    --------
    >>> sentence("mocap.plain", "lay")
    "mocap.plain has no 'lay': it is mocap.plain.transform_clip now."
    """
    new = new_name(room, name)
    return f"{room} has no '{name}': it is {new} now." if new else ""


def missing(room: str, name: str) -> AttributeError:
    """Return the error for a name that a module does not have, for its `__getattr__`.

    Parameters
    ----------
    room, name : as for `new_name`.

    Examples
    --------
    >>> missing("mocap.plain", "walks")
    AttributeError("module 'mocap.plain' has no attribute 'walks'")
    """
    message = sentence(room, name) or f"module '{room}' has no attribute '{name}'"
    return AttributeError(message, name=name)


class OldModules(MetaPathFinder):
    """The last finder of an import: it is asked for modules that do not exist, and names the new ones."""

    def find_spec(self, fullname: str, *unused: object) -> None:
        """Raise for a module that has a new name.

        Parameters
        ----------
        fullname : the module that no other finder has found.
        unused : where Python has searched, and for which module.

        Raises
        ------
        ModuleNotFoundError : with the new name.
        """
        room, _, name = fullname.rpartition(".")
        if message := sentence(room, name):
            raise ModuleNotFoundError(message, name=fullname)


def name_old_modules() -> None:
    """Install the finder by which an import of a renamed module fails with the new name."""
    if not any(isinstance(finder, OldModules) for finder in sys.meta_path):
        sys.meta_path.append(OldModules())
