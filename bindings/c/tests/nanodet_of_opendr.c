/* A program as it was written for OpenDR 3.0's C API: nanodet_of_opendr PICTURE OUT.png */
#include <opendr_compat.h>

int main(int argc, char **argv) {
    const char *json = "{\"threshold\": 0.5, \"classes\": [\"cat\", \"dog\"], \"inference_params\": {\"sizes\": [320, 416]}}";
    NanodetModelT model;
    OpenDRImageT image;
    OpenDRDetectionVectorTargetT results, none;
    OpenDRTensorT tensor, copy;
    OpenDRTensorVectorT tensors;
    float numbers[6] = {0, 1, 2, 3, 4, 5};
    if (argc < 3) return 2;
    loadNanodetModel("", "m", "cpu", 0.35f, 0, 0, &model);
    loadImage(argv[1], &image);
    if (model.network == NULL || image.data == NULL) return 1;
    results = inferNanodet(&model, &image);
    drawBboxes(&image, &model, &results, 1);
    if (opendr_image_save((const opendr_image *)image.data, argv[2]) != OPENDR_OK) return 1;
    for (int i = 0; i < results.size; i++) printf("%d %.2f\n", results.startingPointer[i].name, results.startingPointer[i].score);
    freeDetectionsVector(&results);
    freeImage(&image);
    freeNanodetModel(&model);

    initDetectionsVector(&none);
    if (none.size != 1 || none.startingPointer[0].name != -1) return 1;
    freeDetectionsVector(&none);
    if (strcmp(jsonGetStringFromKey(json, "classes", 1), "dog") != 0) return 1;
    if (strcmp(jsonGetStringFromKey(json, "nothing", 0), "") != 0) return 1;
    if (jsonGetFloatFromKey(json, "threshold", 0) != 0.5f) return 1;
    if (jsonGetFloatFromKeyInInferenceParams(json, "sizes", 1) != 416.0f) return 1;
    loadTensor(&tensor, numbers, 1, 1, 1, 3, 2);
    loadTensorVector(&tensors, &tensor, 1);
    iterTensorVector(&copy, &tensors, 0);
    if (copy.width != 3 || copy.data[5] != 5.0f) return 1;
    freeTensor(&copy);
    freeTensor(&tensor);
    freeTensorVector(&tensors);
    return 0;
}
