//! Tests of the library and the program from outside: results compared with theory, independent computations and closed
//! forms; files, messages and exit statuses of the program. There is one file for each subject; `cargo test --release
//! --test integration surface` runs those of one.
#![allow(clippy::unwrap_used)] // tests, also their helpers, may fail

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/textbook.rs"]
mod textbook;
mod theory;

mod assignments;
mod bad_meshes;
mod bad_scenes;
mod barriers;
mod bent;
mod bloch;
mod bloch_runs;
mod branches;
mod circles;
mod command_line;
mod corpus;
mod disturbed_runs;
mod drawings;
mod driven_scenes;
mod elements;
mod empty_answers;
mod engines;
mod files;
mod films;
mod flat_patterns;
mod flattening;
mod floors;
mod folding_theory;
mod frames;
mod front_door;
mod gallery_paths;
mod hanging_chain;
mod intersections;
mod intrinsic;
mod invariance;
mod kept_states;
mod kinematics;
mod landscape;
mod landscape_map;
mod landscape_runs;
mod landscape_torus;
mod loads_and_units;
mod miura;
mod pages;
mod path_laws;
mod paths;
mod periodic;
mod pinned_wells;
mod reasons;
mod redundant;
mod refused_scenes;
mod response;
mod response_moduli;
mod response_runs;
mod rest_lengths;
mod restarts;
mod resumed_paths;
mod rigid_motions;
mod runs;
mod schema;
mod self_intersection;
mod several_scenes;
mod solver_limits;
mod solver_textbook;
mod sparse_spectra;
mod spectra;
mod started_states;
mod stiffness;
mod stopping;
mod surface;
mod sweep;
mod targets;
mod thin;
mod touching;
mod trace;
mod tube_scenes;
mod tubes;
mod unstressed;
mod validate;
mod waterbomb_base;
mod wells;
mod wells_of_parts;
