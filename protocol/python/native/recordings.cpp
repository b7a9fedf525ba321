// Recordings of frames (protocol/PROTOCOL.md).

#include <pybind11/stl.h>

#include <optional>
#include <string>

#include "protocol/frame/frame_codec.h"
#include "protocol/python/native/bindings.h"
#include "protocol/python/native/frame_dict.h"
#include "protocol/recording/frame_recorder.h"
#include "protocol/recording/html_page.h"
#include "protocol/recording/recording_file.h"
#include "protocol/recording/recording_writer.h"

namespace py = pybind11;

namespace vat::python {
namespace {

/// Writer of a recording.
class Recorder {
 public:
  Recorder(const std::string& file, Real frame_seconds, std::optional<Real> max_error)
      : recorder_({frame_seconds, max_error, {}}),
        writer_(value_of(RecordingWriter::create(file))) {}

  void add(HeldSimulation& held) {
    const HeldSimulation::Turn turn(held);
    require(writer_.write(recorder_.record(turn.get())));
  }
  void finish() { require(writer_.finish()); }

 private:
  FrameRecorder recorder_;
  RecordingWriter writer_;
};

/// Reader of a recording. Frames in order need one decoding each.
class Recording {
 public:
  explicit Recording(const std::string& file) : file_(value_of(RecordingFile::open(file))) {}

  std::size_t frame_count() const { return file_.index().frames().size(); }

  py::dict frame(std::size_t number) {
    if (number >= frame_count()) throw py::index_error("the recording has no such frame");
    if (next_ > number || next_ <= file_.index().key_before(number)) {
      next_ = file_.index().key_before(number);
    }
    const GridFrame* frame = nullptr;
    for (; next_ <= number; ++next_) {
      frame = value_of(decoder_.decode(value_of(file_.frame(next_))));
    }
    return frame_dict(*frame);
  }

  /// Returns the JSON text of the description of a frame.
  std::string description(std::size_t frame) {
    std::size_t last = 0;
    const auto& descriptions = file_.index().descriptions();
    while (last + 1 < descriptions.size() && descriptions[last + 1].first_frame <= frame) ++last;
    return value_of(file_.description(last));
  }

 private:
  RecordingFile file_;
  FrameDecoder decoder_;
  std::size_t next_ = 0;  ///< the frame that the decoder expects
};

}  // namespace

void bind_recordings(py::module_& module) {
  py::class_<Recorder>(module, "Recorder")
      .def(py::init<const std::string&, Real, std::optional<Real>>())
      .def("add", &Recorder::add)
      .def("finish", &Recorder::finish);
  py::class_<Recording>(module, "Recording")
      .def(py::init<const std::string&>())
      .def_property_readonly("frame_count", &Recording::frame_count)
      .def("frame", &Recording::frame)
      .def("description", &Recording::description);
  module.def("write_page",
             [](const std::string& recording, const std::string& page, const std::string& viewer) {
               require(write_html_page(recording, page, viewer));
             });
}

}  // namespace vat::python
