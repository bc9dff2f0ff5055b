//! The controllers at run time: the cascade, its three controllers, what they know of the vehicle, and the rotors' map.

pub(crate) mod activity;
pub(crate) mod altitude_controller;
pub(crate) mod attitude_controller;
pub(crate) mod cascade;
pub(crate) mod estimator;
pub(crate) mod governor;
pub(crate) mod mixer;
pub(crate) mod observer;
pub(crate) mod position_controller;
pub(crate) mod recovery;
pub(crate) mod rotor_monitor;
pub(crate) mod tracking_law;
pub(crate) mod vehicle_motion;
