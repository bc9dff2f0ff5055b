//! A camera: what it does, and the images that it has taken. It takes no pictures: it knows when and where it would have.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::capture::Capture;
use super::image::Image;
use super::lens::{Drive, Lens};
use super::surroundings::Surroundings;
use super::trigger::{Oblique, Trigger};
use crate::Refusal;

/// Room for images and videos, MiB.
pub const STORAGE_MIB: f64 = 32_768.0;
/// What an image takes, MiB.
const IMAGE_MIB: f64 = 8.0;
/// What a second of video takes, MiB.
const VIDEO_MIB_PER_S: f64 = 6.0;
/// Images whose places are remembered.
const REMEMBERED: usize = 1_024;

/// What it is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum CameraMode {
    /// Images.
    #[default]
    Image,
    /// Video.
    Video,
    /// Images of a survey.
    Survey,
}

/// The camera.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Camera {
    mode: CameraMode,
    zoom: Lens,
    focus: Lens,
    capture: Option<Capture>,
    trigger: Trigger,
    /// Images of now, the oldest first.
    images: VecDeque<Image>,
    count: u32,
    triggers: u32,
    recording_since_us: Option<u64>,
    used_mib: f64,
}

impl Camera {
    /// Its mode.
    pub fn mode(&self) -> CameraMode {
        self.mode
    }

    /// Zoom, percent.
    pub fn zoom_percent(&self) -> f64 {
        self.zoom.percent()
    }

    /// Focus, percent.
    pub fn focus_percent(&self) -> f64 {
        self.focus.percent()
    }

    /// Images since the storage was formatted.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Images since the start.
    pub fn triggers(&self) -> u32 {
        self.triggers
    }

    /// Interval, s, of the images that it takes one after the other.
    pub fn interval_s(&self) -> Option<f64> {
        self.capture.filter(Capture::goes_on).map(|capture| capture.interval_s())
    }

    /// For how long it has been recording, s.
    pub fn recording_s(&self, now_us: u64) -> Option<f64> {
        self.recording_since_us.map(|since_us| now_us.saturating_sub(since_us) as f64 / 1e6)
    }

    /// What of the storage is used, MiB.
    pub fn used_mib(&self, now_us: u64) -> f64 {
        let video_mib = self.recording_s(now_us).unwrap_or(0.0) * VIDEO_MIB_PER_S;
        (self.used_mib + video_mib).min(STORAGE_MIB)
    }

    /// Images after number `trigger` since the start, as far as they are remembered.
    pub fn images_after(&self, trigger: u32) -> impl Iterator<Item = &Image> {
        self.images.iter().filter(move |image| image.trigger > trigger)
    }

    /// The image of a number since the storage was formatted.
    pub fn image(&self, index: u32) -> Option<&Image> {
        self.images.iter().rfind(|image| image.index == index)
    }

    /// The latest image.
    pub fn latest(&self) -> Option<&Image> {
        self.images.back()
    }

    /// Swings between images.
    pub fn oblique(&self) -> Option<&Oblique> {
        self.trigger.oblique().filter(|_| self.trigger.is_on())
    }

    /// Whether nothing will happen by itself.
    pub fn rests(&self) -> bool {
        self.capture.is_none() && !self.trigger.is_on() && self.zoom.rests() && self.focus.rests()
    }

    /// Takes images one after the other.
    ///
    /// # Errors
    /// [`Refusal`] while it does so already.
    pub fn start_capture(&mut self, interval_s: f64, count: u32, now_us: u64) -> Result<(), Refusal> {
        if self.interval_s().is_some() {
            return Err(Refusal::later("Image capture rejected: already capturing; stop it first"));
        }
        self.capture = Some(Capture::new(interval_s, count, now_us));
        Ok(())
    }

    /// Takes no more of them.
    pub fn stop_capture(&mut self) {
        self.capture = None;
    }

    /// What triggers it while it flies.
    pub fn trigger_mut(&mut self) -> &mut Trigger {
        &mut self.trigger
    }

    /// Counts triggered images anew.
    pub fn reset_count(&mut self) {
        self.count = 0;
    }

    /// Records, or ends that.
    ///
    /// # Errors
    /// [`Refusal`] while it records already, or does not.
    pub fn record(&mut self, on: bool, now_us: u64) -> Result<(), Refusal> {
        match (on, self.recording_since_us) {
            (true, Some(_)) => Err(Refusal::later("Video rejected: already recording")),
            (false, None) => Err(Refusal::later("Video is not being recorded")),
            (true, None) => {
                self.recording_since_us = Some(now_us);
                Ok(())
            }
            (false, Some(_)) => {
                (self.used_mib, self.recording_since_us) = (self.used_mib(now_us), None);
                Ok(())
            }
        }
    }

    /// Changes the mode.
    pub fn set_mode(&mut self, mode: CameraMode) {
        self.mode = mode;
    }

    /// Zooms.
    pub fn zoom(&mut self, drive: Drive) {
        self.zoom.drive(drive);
    }

    /// Focuses.
    pub fn focus(&mut self, drive: Drive) {
        self.focus.drive(drive);
    }

    /// Sets mode, zoom and focus to what they were at the start.
    pub fn reset(&mut self) {
        (self.mode, self.zoom, self.focus) = Default::default();
    }

    /// Empties the storage.
    ///
    /// # Errors
    /// [`Refusal`] while it is written to.
    pub fn format(&mut self, reset_count: bool) -> Result<(), Refusal> {
        if self.interval_s().is_some() || self.recording_since_us.is_some() {
            return Err(Refusal::later("Format rejected: stop capturing and recording first"));
        }
        self.images.clear();
        self.used_mib = 0.0;
        if reset_count {
            self.count = 0;
        }
        Ok(())
    }

    /// Takes an image now. A full storage takes none.
    ///
    /// # Errors
    /// [`Refusal`] when the storage is full.
    pub fn shoot(&mut self, around: &Surroundings, camera_attitude_rad: Vector3<f64>) -> Result<(), Refusal> {
        if self.used_mib(around.time_us) + IMAGE_MIB > STORAGE_MIB {
            return Err(Refusal::Failed("No image: the storage is full; format it".to_owned()));
        }
        self.count = self.count.saturating_add(1);
        self.triggers = self.triggers.saturating_add(1);
        self.used_mib += IMAGE_MIB;
        if self.images.len() >= REMEMBERED {
            self.images.pop_front();
        }
        self.images.push_back(Image {
            index: self.count,
            trigger: self.triggers,
            time_us: around.time_us,
            position_m: around.position_m,
            home_z_m: around.home_m.z,
            attitude_rad: around.attitude_rad,
            camera_attitude_rad,
        });
        Ok(())
    }

    /// Moves on by a time, s. Returns how many images are due.
    pub fn step(&mut self, around: &Surroundings, dt_s: f64) -> usize {
        self.zoom.step(dt_s);
        self.focus.step(dt_s);
        let asked = self.capture.as_mut().is_some_and(|capture| capture.is_due(around.time_us));
        self.capture = self.capture.filter(Capture::goes_on);
        let triggered = self.trigger.is_due(&around.position_m, around.time_us);
        usize::from(asked) + usize::from(triggered)
    }
}

#[cfg(test)]
mod tests {
    use super::{Camera, STORAGE_MIB, Surroundings, Vector3};
    use crate::equipment::MountSettings;

    fn around(time_us: u64) -> Surroundings {
        Surroundings {
            time_us,
            position_m: Vector3::new(1.0, 2.0, -3.0),
            home_m: Vector3::zeros(),
            mount: MountSettings::default(),
            deflections: [0.0; 3],
            radio_is_lost: false,
            attitude_rad: Vector3::zeros(),
            region_m: None,
            looks: false,
        }
    }

    #[test]
    fn images_are_counted_and_remembered_until_the_storage_is_formatted() {
        let mut camera = Camera::default();
        camera.start_capture(0.5, 3, 0).unwrap();
        assert!(camera.start_capture(0.5, 3, 0).is_err(), "one at a time");
        assert!(camera.format(true).is_err(), "not while it captures");
        for time_us in (0..2_000_000).step_by(1_000) {
            for _ in 0..camera.step(&around(time_us), 0.001) {
                camera.shoot(&around(time_us), Vector3::zeros()).unwrap();
            }
        }
        let times: Vec<_> = camera.images_after(0).map(|image| image.time_us).collect();
        assert_eq!(times, [0, 500_000, 1_000_000]);
        assert_eq!((camera.count(), camera.used_mib(0), camera.rests()), (3, 24.0, true));
        assert_eq!(camera.image(2).unwrap().time_us, 500_000);
        camera.format(true).unwrap();
        assert_eq!((camera.count(), camera.triggers(), camera.used_mib(0)), (0, 3, 0.0));
        camera.shoot(&around(9), Vector3::zeros()).unwrap();
        assert_eq!(camera.images_after(3).map(|image| image.index).collect::<Vec<_>>(), [1]);
    }

    #[test]
    fn a_video_fills_the_storage() {
        let mut camera = Camera::default();
        assert!(camera.record(false, 0).is_err());
        camera.record(true, 0).unwrap();
        assert!(camera.record(true, 0).is_err());
        assert_eq!(camera.recording_s(2_000_000), Some(2.0));
        assert_eq!(camera.used_mib(2_000_000), 12.0);
        assert_eq!(camera.used_mib(u64::MAX), STORAGE_MIB);
        camera.record(false, 10_000_000_000).unwrap();
        assert!(camera.shoot(&around(0), Vector3::zeros()).is_err(), "it is full");
    }
}
