"""The public names; all other names may change without notice."""

from . import plot as plot
from .analysis.analyze import Analysis as Analysis
from .analysis.analyze import ParametricAnalysis as ParametricAnalysis
from .analysis.analyze import analyze as analyze
from .analysis.boxes.largest import LargestRanges as LargestRanges
from .analysis.boxes.largest import LargestUncertainty as LargestUncertainty
from .analysis.boxes.largest import largest_loop_ranges as largest_loop_ranges
from .analysis.boxes.largest import largest_loop_uncertainty as largest_loop_uncertainty
from .analysis.boxes.largest import largest_uncertainty as largest_uncertainty
from .analysis.boxes.loops import box_stability as box_stability
from .analysis.boxes.members import box_controllability as box_controllability
from .analysis.boxes.members import box_fixed_modes as box_fixed_modes
from .analysis.boxes.members import box_observability as box_observability
from .analysis.boxes.members import box_setpoints as box_setpoints
from .analysis.boxes.members import box_stabilizability as box_stabilizability
from .analysis.controllability import ExceptionalGains as ExceptionalGains
from .analysis.controllability import controllability_indices as controllability_indices
from .analysis.controllability import exceptional_gains as exceptional_gains
from .analysis.controllability import joint_controllability as joint_controllability
from .analysis.controllability import joint_observability as joint_observability
from .analysis.controllability import observability_indices as observability_indices
from .analysis.fixed_modes import assignability as assignability
from .analysis.fixed_modes import completeness as completeness
from .analysis.fixed_modes import fixed_spectrum as fixed_spectrum
from .analysis.fixed_modes import pencil_rank as pencil_rank
from .analysis.fixed_modes import pencil_ranks as pencil_ranks
from .analysis.parameters.hypersurfaces import ParametricCompleteness as ParametricCompleteness
from .analysis.parameters.hypersurfaces import ParametricTransferGraph as ParametricTransferGraph
from .analysis.parameters.hypersurfaces import (
    exceptional_hypersurfaces as exceptional_hypersurfaces,
)
from .analysis.parameters.modes import ParametricSharing as ParametricSharing
from .analysis.parameters.modes import (
    shared_dimensions_for_every_value as shared_dimensions_for_every_value,
)
from .analysis.parameters.ranks import signal_solvability as signal_solvability
from .analysis.sharing import common_dimension as common_dimension
from .analysis.sharing import minimal_communication as minimal_communication
from .analysis.sharing import minimal_shared_dimensions as minimal_shared_dimensions
from .analysis.sharing import neighbor_graph as neighbor_graph
from .analysis.sharing import shared_dimension_bound as shared_dimension_bound
from .analysis.single_channel import ErrorGains as ErrorGains
from .analysis.single_channel import error_gains as error_gains
from .analysis.single_channel import single_channel_gains as single_channel_gains
from .analysis.stability import certify_stability as certify_stability
from .analysis.stability import matrix_system as matrix_system
from .analysis.stability import open_loop_spectrum as open_loop_spectrum
from .analysis.structure import complementary_subsystem as complementary_subsystem
from .analysis.structure import setpoint_solvability as setpoint_solvability
from .analysis.structure import transfer_graph as transfer_graph
from .answer.assignability import Assignability as Assignability
from .answer.box_controllable import BoxControllability as BoxControllability
from .answer.box_fixed import BoxFixedModes as BoxFixedModes
from .answer.box_stable import BoxStability as BoxStability
from .answer.check import check as check
from .answer.closed_loop_spectrum import ClosedLoopSpectrum as ClosedLoopSpectrum
from .answer.codec import save_certificate as save_certificate
from .answer.common_dimension import CommonDimension as CommonDimension
from .answer.communication import MinimalCommunication as MinimalCommunication
from .answer.complementary_subsystem import ComplementarySubsystem as ComplementarySubsystem
from .answer.completeness import Completeness as Completeness
from .answer.controllability import JointControllability as JointControllability
from .answer.controllability_indices import ControllabilityIndices as ControllabilityIndices
from .answer.deficiency import Deficiency as Deficiency
from .answer.distributed_observer import DistributedObserver as DistributedObserver
from .answer.evidence import RateInterval as RateInterval
from .answer.evidence import RootDisc as RootDisc
from .answer.exceptional_gains import ExceptionalSet as ExceptionalSet
from .answer.exceptional_hypersurfaces import (
    ExceptionalHypersurfaces as ExceptionalHypersurfaces,
)
from .answer.exceptional_hypersurfaces import Hypersurface as Hypersurface
from .answer.exceptional_hypersurfaces import RankHypersurfaces as RankHypersurfaces
from .answer.fixed_spectrum import FixedFactor as FixedFactor
from .answer.fixed_spectrum import FixedSpectrum as FixedSpectrum
from .answer.neighbor_graph import NeighborGraphVerdict as NeighborGraphVerdict
from .answer.parametric_box_controllable import (
    ParametricBoxControllability as ParametricBoxControllability,
)
from .answer.parametric_box_fixed import ParametricBoxFixedModes as ParametricBoxFixedModes
from .answer.parametric_box_stable import ParametricBoxStability as ParametricBoxStability
from .answer.parametric_fixed_spectrum import ExceptionalValue as ExceptionalValue
from .answer.parametric_fixed_spectrum import ParametricFixedSpectrum as ParametricFixedSpectrum
from .answer.parametric_rank import LowerRank as LowerRank
from .answer.parametric_rank import ParametricRank as ParametricRank
from .answer.pencil_rank import PencilRank as PencilRank
from .answer.protocol import Answer as Answer
from .answer.reading import load_certificate as load_certificate
from .answer.setpoint import SetpointSolvability as SetpointSolvability
from .answer.shared_dimensions import SharedDimensions as SharedDimensions
from .answer.single_channel_gains import SingleChannelGains as SingleChannelGains
from .answer.stability import StabilityVerdict as StabilityVerdict
from .answer.template import Sentence as Sentence
from .answer.transfer_graph import TransferGraph as TransferGraph
from .answer.verdict import Verdict as Verdict
from .crosschecks.table import CrossChecks as CrossChecks
from .crosschecks.table import crosscheck as crosscheck
from .derived.constructions import along_line as along_line
from .derived.constructions import augmented_outputs as augmented_outputs
from .derived.constructions import dual as dual
from .derived.constructions import error_system as error_system
from .derived.constructions import extended_system as extended_system
from .derived.constructions import held_system as held_system
from .derived.constructions import lifted_system as lifted_system
from .derived.constructions import merged as merged
from .derived.constructions import restricted as restricted
from .derived.constructions import setpoint_system as setpoint_system
from .derived.drawn.systems import Draw as Draw
from .derived.variants import Variant as Variant
from .derived.variants import neighbor_graph_variants as neighbor_graph_variants
from .derived.variants import parameter_grid as parameter_grid
from .derived.variants import sensor_variants as sensor_variants
from .errors import FloatRefused as FloatRefused
from .errors import Impossible as Impossible
from .errors import InputError as InputError
from .errors import InternalError as InternalError
from .errors import LimitReached as LimitReached
from .errors import McexactError as McexactError
from .errors import MissingExtra as MissingExtra
from .errors import NotWritten as NotWritten
from .errors import OtherFormat as OtherFormat
from .errors import OutOfReach as OutOfReach
from .errors import UsageError as UsageError
from .exact.matrix import Matrix as Matrix
from .exact.polynomial import Polynomial as Polynomial
from .exact.roots import StabilityRegion as StabilityRegion
from .model.box import Box as Box
from .model.controller import AgentProgram as AgentProgram
from .model.controller import Controller as Controller
from .model.controller import LinearMap as LinearMap
from .model.controller import load_controller as load_controller
from .model.controller import save_controller as save_controller
from .model.files import load_parametric_system as load_parametric_system
from .model.files import load_system as load_system
from .model.files import save_system as save_system
from .model.gallery import gallery as gallery
from .model.graph import NeighborGraph as NeighborGraph
from .model.parametric import ParametricSystem as ParametricSystem
from .model.radii import Radii as Radii
from .model.statespace import c2d as c2d
from .model.statespace import from_statespace as from_statespace
from .model.statespace import local_controllers as local_controllers
from .model.statespace import loop_from_statespace as loop_from_statespace
from .model.statespace import to_statespace as to_statespace
from .model.system import MultiChannelSystem as MultiChannelSystem
from .model.system import from_stacked as from_stacked
from .report.text import to_pandas as to_pandas
from .simulation.envelope import Envelope as Envelope
from .simulation.envelope import proved_envelope as proved_envelope
from .simulation.network import SignalNotReceived as SignalNotReceived
from .simulation.trajectory import Trajectory as Trajectory
from .simulation.trajectory import simulate as simulate
from .sweeps.run import Record as Record
from .sweeps.run import sweep as sweep
from .synthesis.assessment import Assessment as Assessment
from .synthesis.assessment import assess as assess
from .synthesis.certify import certify_controller as certify_controller
from .synthesis.decentralized import design_decentralized as design_decentralized
from .synthesis.decentralized import design_extended as design_extended
from .synthesis.design import Design as Design
from .synthesis.distributed_observer import design_observer as design_observer
from .synthesis.gate import CertifiedLoop as CertifiedLoop
from .synthesis.optimum.figures import Aims as Aims
from .synthesis.setpoint import design_setpoint as design_setpoint

__version__: str
__all__: list[str]
