//! `creases` and `facets` of `[energy]`: how creases fold and polygons bend.

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Error, IntoDeserializer, MapAccess};

use super::law::{HingeLawSpec, HingeYieldSpec};
use super::law_form::LawForm;
use crate::scene::Located;
use crate::scene::rest::RestSpec;
use crate::scene::stiffness::StiffnessSpec;
use crate::scene::values::Fraction;
use crate::sheet::written::{Written, read_as_written, schema_any_of};

/// `creases = { stiffness, rest, fraction, law, yield }`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CreasesSpec {
    /// Torque per radian and per length of crease; the spring constant is stiffness * L0. Left out: that of the
    /// material.
    pub stiffness: Option<Located<StiffnessSpec>>,
    /// Rest angles; left out: as drawn.
    pub rest: Option<Located<RestSpec>>,
    /// Factor on the rest angles, from -1 (folded to the other side) by way of 0 (flat) to 1 (folded): of
    /// `rest = "target"`, `"assigned"` or a table by letters.
    pub fraction: Option<Located<Fraction>>,
    /// How the torque grows with the angle; left out: linearly.
    pub law: Option<Located<LawForm<HingeLawSpec>>>,
    /// Where it yields; left out: nowhere.
    #[serde(rename = "yield")]
    pub yields: Option<Located<HingeYieldSpec>>,
}

/// The model by which quadrilaterals bend, named by the vertices and bars of one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum FacetModel {
    /// Along the shorter diagonal.
    #[default]
    N4B5,
    /// Along both diagonals, which cross in a vertex of their own.
    N5B8,
}

/// `facets = { model, stiffness, rest, fraction, law, yield }`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FacetsSpec {
    /// How quadrilaterals bend; left out: `N4B5`.
    model: Option<FacetModel>,
    /// Torque per radian and per length of diagonal; the spring constant is stiffness * L0. Left out: that of the
    /// material.
    stiffness: Option<Located<StiffnessSpec>>,
    /// Rest angles; left out: as drawn.
    rest: Option<Located<RestSpec>>,
    /// Factor on the rest angles, from -1 (folded to the other side) by way of 0 (flat) to 1 (folded): of
    /// `rest = "target"`, `"assigned"` or a table by letters.
    fraction: Option<Located<Fraction>>,
    /// How the torque grows with the angle; left out: linearly.
    law: Option<Located<LawForm<HingeLawSpec>>>,
    /// Where it yields; left out: nowhere.
    #[serde(rename = "yield")]
    yields: Option<Located<HingeYieldSpec>>,
}

/// The model of facets and the keys that they have in common with creases.
#[derive(Clone, Debug)]
pub struct FacetsForm {
    /// How quadrilaterals bend; left out: `N4B5`.
    pub model: Option<FacetModel>,
    /// The keys of hinges.
    pub hinges: CreasesSpec,
}

read_as_written!(FacetsForm);

impl Written for FacetsForm {
    const FORMS: &str = "\"N4B5\", \"N5B8\" or a table { model, stiffness, rest, fraction, law }";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        let deserializer: StrDeserializer<E> = word.into_deserializer();
        Ok(Self { model: Some(FacetModel::deserialize(deserializer)?), hinges: CreasesSpec::default() })
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        let table = FacetsSpec::deserialize(MapAccessDeserializer::new(map))?;
        let FacetsSpec { model, stiffness, rest, fraction, law, yields } = table;
        Ok(Self { model, hinges: CreasesSpec { stiffness, rest, fraction, law, yields } })
    }
}

schema_any_of!(
    FacetsForm as "Facets",
    generator,
    [generator.subschema_for::<FacetModel>(), generator.subschema_for::<FacetsSpec>()]
);
