//! Studies of one kind, from their scene to their summary and tables.

mod assemblies;
mod barriers;
mod bloch_runs;
mod coupled_tubes;
mod drums;
mod empty_answers;
mod folds;
mod gallery_paths;
mod kept_states;
mod landscape_runs;
mod laws;
mod laws_by_letter;
mod membranes;
mod modes_of_parts;
mod panels;
mod paths;
mod periodic_paths;
mod pinned_wells;
mod plasticity;
mod pressure;
mod reasons;
mod response_runs;
mod snaps;
mod touching;
mod waterbomb_base;
mod wells_of_parts;
