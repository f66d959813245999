/* A program written for OpenDR 3.0's C API: object_detection_2d_nanodet_jit IMAGE OUT.png */
#undef NDEBUG
#include <assert.h>

#include "object_detection_2d_nanodet_jit.h"
#include "opendr_utils.h"

int main(int argc, char **argv) {
    char device[] = "cpu";
    NanodetModelT model, missing;
    OpenDRImageT image, none;
    OpenDRDetectionVectorTargetT results;
    assert(argc == 3);
    loadNanodetModel("", "m", device, 0.35f, 0, 0, &model);
    loadImage(argv[1], &image);
    assert(model.network != NULL && image.data != NULL && model.numberOfClasses == 80);
    results = inferNanodet(&model, &image);
    drawBboxes(&image, &model, &results, 1);
    assert(opendr_image_save((const opendr_image *)image.data, argv[2]) == OPENDR_OK);
    for (int i = 0; i < results.size; i++)
        printf("%d %.2f\n", results.startingPointer[i].name, (double)results.startingPointer[i].score);
    freeDetectionsVector(&results);

    none.data = NULL;
    results = inferNanodet(&model, &none);
    assert(results.size == 1 && results.startingPointer[0].name == -1);
    freeDetectionsVector(&results);
    loadNanodetModel("no/such/model", "m", device, 0.35f, 0, 0, &missing);
    assert(missing.network == NULL && missing.device == NULL);
    freeNanodetModel(&missing);

    freeImage(&image);
    freeNanodetModel(&model);
    freeNanodetModel(&model);
    return 0;
}
