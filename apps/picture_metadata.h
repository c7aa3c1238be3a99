// What a picture file says of how it was made.
#pragma once

#include "apps/render_arguments.h"
#include "loaders/image_file.h"

namespace alhazen {

/// Names are those of docs/rendering.md. Where SOURCE_DATE_EPOCH is set the date is that one and the render's time is
/// left out, so that the same picture makes the same file.
[[nodiscard]] Metadata picture_metadata(const RenderArguments& arguments, const RenderControl& control, bool complete,
                                        double render_seconds);

}  // namespace alhazen
