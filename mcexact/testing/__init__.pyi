from .strategies import Drawn as Drawn
from .strategies import HypothesisChoices as HypothesisChoices
from .strategies import assert_valid as assert_valid
from .strategies import incomplete_systems as incomplete_systems
from .strategies import jointly_controllable_systems as jointly_controllable_systems
from .strategies import members as members
from .strategies import neighbor_graphs as neighbor_graphs
from .strategies import parametric_systems as parametric_systems
from .strategies import sparse_systems as sparse_systems
from .strategies import systems as systems
from .strategies import systems_on_graphs as systems_on_graphs
from .strategies import systems_with_deficiency as systems_with_deficiency
from .strategies import systems_with_fixed_mode as systems_with_fixed_mode
from .strategies import systems_with_indices as systems_with_indices
from .strategies import systems_with_joint_modes as systems_with_joint_modes
from .strategies import systems_with_remnant as systems_with_remnant
from .strategies import uncontrollable_systems as uncontrollable_systems

__all__: list[str]
