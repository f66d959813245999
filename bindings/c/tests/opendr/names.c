/* Every name of OpenDR's C API (3.0, and 2 where that spelt it differently) is declared, with its type: this compiles. */
#undef NDEBUG
#include <assert.h>

#include "activity_recognition_x3d.h"
#include "data.h"
#include "face_recognition.h"
#include "lightweight_open_pose.h"
#include "object_detection_2d_detr.h"
#include "object_detection_2d_nanodet_jit.h"
#include "object_detection_2d_yolov5.h"
#include "object_tracking_2d_deep_sort.h"
#include "opendr_utils.h"
#include "skeleton_based_action_recognition_pst.h"
#include "target.h"

/* A function: its return type, its name, its parameters. */
#define FUNCTIONS(F) \
    F(const char *, jsonGetStringFromKey, (const char *, const char *, int)) \
    F(float, jsonGetFloatFromKey, (const char *, const char *, int)) \
    F(const char *, jsonGetStringFromKeyInInferenceParams, (const char *, const char *, int)) \
    F(float, jsonGetFloatFromKeyInInferenceParams, (const char *, const char *, int)) \
    F(float, jsonGetKeyFromInferenceParams, (const char *, const char *, int)) \
    F(void, loadImage, (const char *, OpenDRImageT *)) \
    F(void, freeImage, (OpenDRImageT *)) \
    F(void, initDetectionsVector, (OpenDRDetectionVectorTargetT *)) \
    F(void, loadDetectionsVector, (OpenDRDetectionVectorTargetT *, OpenDRDetectionTargetT *, int)) \
    F(void, freeDetectionsVector, (OpenDRDetectionVectorTargetT *)) \
    F(void, initTensor, (OpenDRTensorT *)) \
    F(void, loadTensor, (OpenDRTensorT *, void *, int, int, int, int, int)) \
    F(void, freeTensor, (OpenDRTensorT *)) \
    F(void, initTensorVector, (OpenDRTensorVectorT *)) \
    F(void, loadTensorVector, (OpenDRTensorVectorT *, OpenDRTensorT *, int)) \
    F(void, freeTensorVector, (OpenDRTensorVectorT *)) \
    F(void, iterTensorVector, (OpenDRTensorT *, OpenDRTensorVectorT *, int)) \
    F(void, loadFaceRecognitionModel, (const char *, FaceRecognitionModelT *)) \
    F(OpenDRCategoryTargetT, inferFaceRecognition, (FaceRecognitionModelT *, OpenDRImageT *)) \
    F(void, buildDatabaseFaceRecognition, (const char *, const char *, FaceRecognitionModelT *)) \
    F(void, loadDatabaseFaceRecognition, (const char *, FaceRecognitionModelT *)) \
    F(void, decodeCategoryFaceRecognition, (FaceRecognitionModelT *, OpenDRCategoryTargetT, char *)) \
    F(void, freeFaceRecognitionModel, (FaceRecognitionModelT *)) \
    F(void, loadNanodetModel, (const char *, const char *, const char *, float, int, int, NanodetModelT *)) \
    F(OpenDRDetectionVectorTargetT, inferNanodet, (NanodetModelT *, OpenDRImageT *)) \
    F(void, drawBboxes, (OpenDRImageT *, NanodetModelT *, OpenDRDetectionVectorTargetT *, int)) \
    F(void, freeNanodetModel, (NanodetModelT *)) \
    F(void, loadDetrModel, (const char *, DetrModelT *)) \
    F(void, forwardDetr, (DetrModelT *, OpenDRTensorT *, OpenDRTensorVectorT *)) \
    F(void, freeDetrModel, (DetrModelT *)) \
    F(void, initRandomOpenDRTensorDetr, (OpenDRTensorT *, DetrModelT *)) \
    F(void, loadDeepSortModel, (const char *, DeepSortModelT *)) \
    F(void, forwardDeepSort, (DeepSortModelT *, OpenDRTensorT *, OpenDRTensorVectorT *)) \
    F(void, freeDeepSortModel, (DeepSortModelT *)) \
    F(void, initRandomOpenDRTensorDs, (OpenDRTensorT *, DeepSortModelT *)) \
    F(void, loadOpenPoseModel, (const char *, OpenPoseModelT *)) \
    F(void, forwardOpenPose, (OpenPoseModelT *, OpenDRTensorT *, OpenDRTensorVectorT *)) \
    F(void, freeOpenPoseModel, (OpenPoseModelT *)) \
    F(void, initOpenDRTensorFromImgOp, (OpenDRImageT *, OpenDRTensorT *, OpenPoseModelT *)) \
    F(void, initRandomOpenDRTensorOp, (OpenDRTensorT *, OpenPoseModelT *)) \
    F(void, loadX3dModel, (const char *, char *, X3dModelT *)) \
    F(void, forwardX3d, (X3dModelT *, OpenDRTensorT *, OpenDRTensorVectorT *)) \
    F(void, freeX3dModel, (X3dModelT *)) \
    F(void, initRandomOpenDRTensorX3d, (OpenDRTensorT *, X3dModelT *)) \
    F(void, loadPstModel, (const char *, PstModelT *)) \
    F(void, forwardPst, (PstModelT *, OpenDRTensorT *, OpenDRTensorVectorT *)) \
    F(void, freePstModel, (PstModelT *)) \
    F(void, initRandomOpenDRTensorPst, (OpenDRTensorT *, PstModelT *)) \
    F(void, loadYolov5Model, (const char *, const char *, const char *, float, float, int, int, Yolov5ModelT *)) \
    F(OpenDRDetectionVectorTargetT, inferYolov5, (Yolov5ModelT *, OpenDRImageT *)) \
    F(void, freeYolov5Model, (Yolov5ModelT *)) \
    F(void, initRandomOpendrTensorDetr, (OpendrTensorT *, DetrModelT *)) \
    F(void, initRandomOpendrTensorDs, (OpendrTensorT *, DeepSortModelT *)) \
    F(void, initOpendrTensorFromImgOp, (OpendrImageT *, OpendrTensorT *, OpenPoseModelT *)) \
    F(void, initRandomOpendrTensorOp, (OpendrTensorT *, OpenPoseModelT *)) \
    F(void, initRandomOpendrTensorX3d, (OpendrTensorT *, X3dModelT *)) \
    F(void, initRandomOpendrTensorPst, (OpendrTensorT *, PstModelT *))

/* A field: its structure, its name, its type. */
#define FIELDS(F) \
    F(OpenDRImage, data, void *) \
    F(OpenDRTensor, batchSize, int) F(OpenDRTensor, frames, int) F(OpenDRTensor, channels, int) \
    F(OpenDRTensor, width, int) F(OpenDRTensor, height, int) F(OpenDRTensor, data, float *) \
    F(OpenDRTensorVector, nTensors, int) F(OpenDRTensorVector, batchSizes, int *) F(OpenDRTensorVector, frames, int *) \
    F(OpenDRTensorVector, channels, int *) F(OpenDRTensorVector, widths, int *) F(OpenDRTensorVector, heights, int *) \
    F(OpenDRTensorVector, datas, float **) \
    F(OpenDRStringsVector, data, char **) F(OpenDRStringsVector, size, int) \
    F(OpenDRCategoryTarget, data, int) F(OpenDRCategoryTarget, confidence, float) \
    F(OpenDRDetectionTarget, name, int) F(OpenDRDetectionTarget, left, float) F(OpenDRDetectionTarget, top, float) \
    F(OpenDRDetectionTarget, width, float) F(OpenDRDetectionTarget, height, float) F(OpenDRDetectionTarget, score, float) \
    F(OpenDRDetectionVectorTarget, startingPointer, OpenDRDetectionTargetT *) F(OpenDRDetectionVectorTarget, size, int) \
    F(FaceRecognitionModel, onnxSession, void *) F(FaceRecognitionModel, env, void *) \
    F(FaceRecognitionModel, sessionOptions, void *) F(FaceRecognitionModel, modelSize, int) \
    F(FaceRecognitionModel, resizeSize, int) F(FaceRecognitionModel, meanValue, float) \
    F(FaceRecognitionModel, stdValue, float) F(FaceRecognitionModel, threshold, float) \
    F(FaceRecognitionModel, outputSize, int) F(FaceRecognitionModel, database, void *) \
    F(FaceRecognitionModel, databaseIds, int *) F(FaceRecognitionModel, personNames, char **) \
    F(FaceRecognitionModel, nPersons, int) F(FaceRecognitionModel, nFeatures, int) \
    F(NanodetModel, network, void *) F(NanodetModel, device, char *) F(NanodetModel, colorList, int **) \
    F(NanodetModel, numberOfClasses, int) F(NanodetModel, scoreThreshold, float) F(NanodetModel, keepRatio, int) \
    F(DetrModel, onnxSession, void *) F(DetrModel, env, void *) F(DetrModel, sessionOptions, void *) \
    F(DetrModel, modelSize, int) F(DetrModel, threshold, float) F(DetrModel, features, int) \
    F(DeepSortModel, onnxSession, void *) F(DeepSortModel, env, void *) F(DeepSortModel, sessionOptions, void *) \
    F(DeepSortModel, inChannels, int) F(DeepSortModel, batchSize, int) F(DeepSortModel, features, int) \
    F(OpenPoseModel, onnxSession, void *) F(OpenPoseModel, env, void *) F(OpenPoseModel, sessionOptions, void *) \
    F(OpenPoseModel, modelSize, int) F(OpenPoseModel, meanValue, float) F(OpenPoseModel, imgScale, float) \
    F(OpenPoseModel, nRefinementStages, int) F(OpenPoseModel, outputSize, int) F(OpenPoseModel, stride, int) \
    F(OpenPoseModel, evenChannelOutput, int) F(OpenPoseModel, oddChannelOutput, int) F(OpenPoseModel, batchSize, int) \
    F(OpenPoseModel, widthOutput, int) F(OpenPoseModel, heightOutput, int) \
    F(X3dModel, onnxSession, void *) F(X3dModel, env, void *) F(X3dModel, sessionOptions, void *) \
    F(X3dModel, modelSize, int) F(X3dModel, framesPerClip, int) F(X3dModel, inChannels, int) F(X3dModel, batchSize, int) \
    F(X3dModel, meanValue, float) F(X3dModel, imgScale, float) F(X3dModel, features, int) \
    F(PstModel, onnxSession, void *) F(PstModel, env, void *) F(PstModel, sessionOptions, void *) \
    F(PstModel, batchSize, int) F(PstModel, inChannels, int) F(PstModel, features, int) F(PstModel, nPoint, int) \
    F(PstModel, nPerson, int) F(PstModel, nClasses, int) \
    F(Yolov5Model, onnxSession, void *) F(Yolov5Model, env, void *) F(Yolov5Model, sessionOptions, void *) \
    F(Yolov5Model, confThreshold, float) F(Yolov5Model, iouThreshold, float) F(Yolov5Model, labels, OpenDRStringsVectorT) \
    F(Yolov5Model, colorList, int **) F(Yolov5Model, numberOfClasses, int) F(Yolov5Model, isDynamicInputShape, int)

/* An array: its structure, its name, the type and the number of its items. */
#define ARRAYS(F) \
    F(NanodetModel, inputSizes, int, 2) \
    F(DetrModel, meanValue, float, 3) F(DetrModel, stdValue, float, 3) F(DetrModel, outputSizes, int, 2) \
    F(DeepSortModel, modelSize, int, 2) F(DeepSortModel, meanValue, float, 3) F(DeepSortModel, stdValue, float, 3) \
    F(Yolov5Model, inputSizes, int, 2)

/* A type: its name, its structure. */
#define TYPES(F) \
    F(OpenDRImageT, OpenDRImage) F(OpenDRTensorT, OpenDRTensor) F(OpenDRTensorVectorT, OpenDRTensorVector) \
    F(OpenDRStringsVectorT, OpenDRStringsVector) F(OpenDRCategoryTargetT, OpenDRCategoryTarget) \
    F(OpenDRDetectionTargetT, OpenDRDetectionTarget) F(OpenDRDetectionVectorTargetT, OpenDRDetectionVectorTarget) \
    F(FaceRecognitionModelT, FaceRecognitionModel) F(NanodetModelT, NanodetModel) F(DetrModelT, DetrModel) \
    F(DeepSortModelT, DeepSortModel) F(OpenPoseModelT, OpenPoseModel) F(X3dModelT, X3dModel) F(PstModelT, PstModel) \
    F(Yolov5ModelT, Yolov5Model) \
    F(OpendrImageT, OpenDRImage) F(OpendrTensorT, OpenDRTensor) F(OpendrTensorVectorT, OpenDRTensorVector) \
    F(OpendrCategoryTargetT, OpenDRCategoryTarget) F(OpendrDetectionTargetT, OpenDRDetectionTarget) \
    F(OpendrDetectionVectorTargetT, OpenDRDetectionVectorTarget)

#define CHECK_FUNCTION(result, name, arguments) \
    { \
        result(*function) arguments = name; \
        assert(function != NULL); \
        functions++; \
    }
#define CHECK_FIELD(structure, name, type) \
    { \
        struct structure value; \
        type *field = &value.name; \
        assert((char *)field >= (char *)&value); \
    }
#define CHECK_ARRAY(structure, name, type, count) \
    { \
        struct structure value; \
        type(*field)[count] = &value.name; \
        assert((char *)field >= (char *)&value); \
    }
#define CHECK_TYPE(name, structure) \
    { \
        name *value = (struct structure *)NULL; \
        assert(value == NULL); \
    }

int main(void) {
    int functions = 0;
    FUNCTIONS(CHECK_FUNCTION)
    FIELDS(CHECK_FIELD)
    ARRAYS(CHECK_ARRAY)
    TYPES(CHECK_TYPE)
    printf("%d functions\n", functions);
    return 0;
}
