#ifndef OPENDR_COMPAT_H
#define OPENDR_COMPAT_H

/*
 * OpenDR 3.0's own names over opendr.h, for programs that were written for its C API. The names are frozen; docs/c.md has a
 * table of them. Each header of OpenDR is in the folder opendr, by its name; this one includes all of them.
 *
 * Failures: as in OpenDR, functions return nothing. They print what went wrong to stderr, opendr_last_error() has it too, and
 * a model that was not loaded has NULL for its handles.
 *
 * Memory: loadX() and initX() begin a model, picture or vector, and freeX() of the same name frees it; freeing it again does
 * nothing. loadTensor(), loadTensorVector(), loadDetectionsVector(), iterTensorVector(), forwardX() and the initX() that fill
 * a tensor take what was begun by initTensor(), initTensorVector() or initDetectionsVector(), and free what is in it.
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
