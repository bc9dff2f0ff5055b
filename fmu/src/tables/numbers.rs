//! Enumerations as integers, for importers that know no enumerations: libcosim and ecos are such.

use fmi::Model;
use fmi::variables::Variable;

/// The airframe.
pub(crate) const fn airframe<M: Model>() -> [Variable<M>; 1] {
    [Variable::number(
        "airframe.preset_number",
        "airframe.preset by its number, which wins over the name; 0: as airframe.preset says",
        "airframe.preset",
    )]
}

/// The controllers.
pub(crate) const fn controllers<M: Model>() -> [Variable<M>; 2] {
    [
        Variable::number(
            "controller.kind_number",
            "controller.kind by its number, which wins over the name; 0: as controller.kind says",
            "controller.kind",
        ),
        Variable::number(
            "controller.model_number",
            "controller.model by its number, which wins over the name; 0: as controller.model says",
            "controller.model",
        ),
    ]
}
