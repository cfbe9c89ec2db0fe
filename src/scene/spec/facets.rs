//! `facets` of `[energy]`: how polygons bend.

use std::ops::Deref;

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
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FacetsSpec {
    /// How quadrilaterals bend; left out: `N4B5`.
    pub model: Option<FacetModel>,
    /// Torque per radian and per length of diagonal; the spring constant is stiffness * L0. Left out: that of the
    /// material.
    pub stiffness: Option<Located<StiffnessSpec>>,
    /// Rest angles; left out: as drawn.
    pub rest: Option<Located<RestSpec>>,
    /// Factor on the rest angles, from flat (0) to folded (1): of `rest = "target"`, `"assigned"` or a table by
    /// letters.
    pub fraction: Option<Located<Fraction>>,
    /// How the torque grows with the angle; left out: linearly.
    pub law: Option<Located<LawForm<HingeLawSpec>>>,
    /// Where it yields; left out: nowhere.
    #[serde(rename = "yield")]
    pub yields: Option<Located<HingeYieldSpec>>,
}

/// [`FacetsSpec`], or the name of its model alone.
#[derive(Clone, Debug)]
pub struct FacetsForm(FacetsSpec);

impl Deref for FacetsForm {
    type Target = FacetsSpec;

    fn deref(&self) -> &FacetsSpec {
        &self.0
    }
}

read_as_written!(FacetsForm);

impl Written for FacetsForm {
    const FORMS: &str = "\"N4B5\", \"N5B8\" or a table { model, stiffness, rest, fraction, law }";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        let deserializer: StrDeserializer<E> = word.into_deserializer();
        Ok(Self(FacetsSpec { model: Some(FacetModel::deserialize(deserializer)?), ..FacetsSpec::default() }))
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        FacetsSpec::deserialize(MapAccessDeserializer::new(map)).map(Self)
    }
}

schema_any_of!(
    FacetsForm as "Facets",
    generator,
    [generator.subschema_for::<FacetModel>(), generator.subschema_for::<FacetsSpec>()]
);
