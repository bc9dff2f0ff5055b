//! The closed-loop quadrotor as an FMI 2.0 co-simulation library.
