#ifndef OPENDR_COMPAT_H
#define OPENDR_COMPAT_H

/*
 * OpenDR 3.0's own names, implemented with opendr.h, for programs written for its C API. The names are frozen; docs/c.md has a
 * table of them. Each header of OpenDR is in the folder opendr, under its name; this header includes all of them.
 *
 * Errors: as in OpenDR, functions return nothing. They print the message to stderr, opendr_last_error() returns it too, and
 * the handles of a model that was not loaded are NULL.
 *
 * Memory: loadX() and initX() initialise a model, image or vector, and freeX() of the same name frees it; freeing it again does
 * nothing. loadTensor(), loadTensorVector(), loadDetectionsVector(), iterTensorVector(), forwardX() and the initX() that fill
 * a tensor take objects initialised by initTensor(), initTensorVector() or initDetectionsVector(), and free their content.
 */
#include "opendr/activity_recognition_x3d.h"
#include "opendr/data.h"
#include "opendr/face_recognition.h"
#include "opendr/lightweight_open_pose.h"
#include "opendr/object_detection_2d_detr.h"
#include "opendr/object_detection_2d_nanodet_jit.h"
#include "opendr/object_detection_2d_yolov5.h"
#include "opendr/object_tracking_2d_deep_sort.h"
#include "opendr/opendr_utils.h"
#include "opendr/skeleton_based_action_recognition_pst.h"
#include "opendr/target.h"

#endif /* OPENDR_COMPAT_H */
