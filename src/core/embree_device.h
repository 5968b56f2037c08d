// Embree's device.
#pragma once

#include <embree3/rtcore.h>

#include <new>
#include <stdexcept>

namespace keyhole {

/// A device; its user releases it. `config`: as rtcNewDevice() takes it, may be null.
/// @throws std::bad_alloc, or std::runtime_error for any other cause
inline RTCDevice new_device(const char* config) {
    if (RTCDevice device = rtcNewDevice(config); device != nullptr) return device;
    if (rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("Embree gave no device");
}

} // namespace keyhole
