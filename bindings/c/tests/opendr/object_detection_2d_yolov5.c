/* A program written for OpenDR's C API after 3.0: object_detection_2d_yolov5 MODEL IMAGE */
#undef NDEBUG
#include <assert.h>

#include "object_detection_2d_yolov5.h"
#include "opendr_utils.h"

int main(int argc, char **argv) {
    Yolov5ModelT model, missing;
    OpenDRImageT image;
    OpenDRDetectionVectorTargetT results;
    assert(argc == 3);
    loadYolov5Model(argv[1], "s", "cpu", 0, 0.6f, 0, 0, &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    assert(model.confThreshold == 0.25f && model.iouThreshold == 0.6f);
    assert(model.numberOfClasses == 2 && model.labels.size == 2 && strcmp(model.labels.data[1], "dog") == 0);
    assert(model.inputSizes[0] == 32 && model.inputSizes[1] == 64 && model.isDynamicInputShape == 1);
    assert(model.colorList[1][2] >= 0 && model.colorList[1][2] < 256);
    loadImage(argv[2], &image);
    assert(image.data != NULL);
    results = inferYolov5(&model, &image);
    assert(results.size == 1 && results.startingPointer[0].name == -1);
    assert(strstr(opendr_last_error(), "OPENDR_UNSUPPORTED") != NULL);
    freeDetectionsVector(&results);
    freeImage(&image);
    freeYolov5Model(&model);
    freeYolov5Model(&model);

    /* Another of the models in the folder, which takes any size. */
    loadYolov5Model(argv[1], "m", "cpu", 0.5f, 0, 96, 0, &model);
    assert(model.onnxSession != NULL && model.confThreshold == 0.5f && model.iouThreshold == 0.45f);
    assert(model.inputSizes[0] == 416 && model.inputSizes[1] == 96 && model.isDynamicInputShape == 0);
    freeYolov5Model(&model);

    loadYolov5Model(argv[1], "x", "cpu", 0, 0, 0, 0, &missing);
    assert(missing.onnxSession == NULL && missing.labels.size == 0);
    freeYolov5Model(&missing);
    loadYolov5Model(argv[1], "s", "gpu", 0, 0, 0, 0, &missing);
    assert(missing.onnxSession == NULL && strstr(opendr_last_error(), "cuda") != NULL);
    freeYolov5Model(&missing);
    return 0;
}
