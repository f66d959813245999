/* A program written for OpenDR 3.0's C API: opendr_utils IMAGE */
#undef NDEBUG
#include <assert.h>

#include "data.h"
#include "opendr_utils.h"
#include "target.h"

static void json(void) {
    const char *text =
        "{\"threshold\": 0.5, \"classes\": [\"cat\", \"dog\"], \"inference_params\": {\"sizes\": [320, 416], \"name\": \"m\"}}";
    assert(strcmp(jsonGetStringFromKey(text, "classes", 1), "dog") == 0);
    assert(strcmp(jsonGetStringFromKey(text, "classes", 2), "") == 0);
    assert(strcmp(jsonGetStringFromKey(text, "nothing", 0), "") == 0);
    assert(strcmp(jsonGetStringFromKey("no JSON", "classes", 0), "") == 0);
    assert(jsonGetFloatFromKey(text, "threshold", 0) == 0.5f && jsonGetFloatFromKey(text, "classes", 0) == 0.0f);
    assert(strcmp(jsonGetStringFromKeyInInferenceParams(text, "name", 0), "m") == 0);
    assert(jsonGetFloatFromKeyInInferenceParams(text, "sizes", 1) == 416.0f);
    assert(jsonGetKeyFromInferenceParams(text, "sizes", 0) == 320.0f);
    assert(jsonGetKeyFloat(text, "threshold", 0) == 0.5f && strcmp(jsonGetKeyString(text, "classes", 0), "cat") == 0);
}

static void pictures(const char *path) {
    OpenDRImageT image;
    loadImage(path, &image);
    assert(image.data != NULL);
    freeImage(&image);
    assert(image.data == NULL);
    freeImage(&image);
    loadImage("no/such/picture.jpg", &image);
    assert(image.data == NULL);
    freeImage(&image);
}

static void detections(void) {
    OpenDRDetectionTargetT found[2] = {{3, 1.0f, 2.0f, 3.0f, 4.0f, 0.5f}, {7, 5.0f, 6.0f, 7.0f, 8.0f, 0.25f}};
    OpenDRDetectionVectorTargetT vector;
    initDetectionsVector(&vector);
    assert(vector.size == 1 && vector.startingPointer[0].name == -1 && vector.startingPointer[0].score == 0.0f);
    loadDetectionsVector(&vector, found, 2);
    assert(vector.size == 2 && vector.startingPointer[1].name == 7 && vector.startingPointer[1].height == 8.0f);
    loadDetectionsVector(&vector, vector.startingPointer, 1);
    assert(vector.size == 1 && vector.startingPointer[0].name == 3);
    loadDetectionsVector(&vector, found, -1);
    assert(vector.size == 0);
    freeDetectionsVector(&vector);
    assert(vector.startingPointer == NULL);
    freeDetectionsVector(&vector);
}

static void tensors(void) {
    float numbers[6] = {0, 1, 2, 3, 4, 5};
    OpenDRTensorT tensor, copy, both[2];
    OpenDRTensorVectorT vector;
    initTensor(&tensor);
    initTensor(&copy);
    initTensorVector(&vector);
    loadTensor(&tensor, numbers, 1, 1, 1, 3, 2);
    assert(tensor.width == 3 && tensor.height == 2 && tensor.data != numbers && tensor.data[5] == 5.0f);
    loadTensor(&tensor, numbers, 1, 1, 3, 2, 1);
    assert(tensor.channels == 3 && tensor.data[5] == 5.0f);
    both[0] = both[1] = tensor;
    loadTensorVector(&vector, &tensor, 1);
    loadTensorVector(&vector, both, 2);
    assert(vector.nTensors == 2 && vector.channels[1] == 3 && vector.datas[1][4] == 4.0f);
    iterTensorVector(&copy, &vector, 1);
    assert(copy.channels == 3 && copy.data[5] == 5.0f);
    iterTensorVector(&copy, &vector, 0);
    iterTensorVector(&copy, &vector, 2);
    assert(copy.data == NULL && copy.channels == 0);
    loadTensor(&copy, numbers, 1, 1, 0, 3, 2);
    assert(copy.data == NULL && copy.width == 0);
    loadTensor(&copy, numbers, 1 << 30, 1 << 30, 1 << 30, 3, 2);
    assert(copy.data == NULL);
    freeTensor(&copy);
    freeTensor(&tensor);
    freeTensor(&tensor);
    freeTensorVector(&vector);
    assert(vector.nTensors == 0 && vector.datas == NULL);
    freeTensorVector(&vector);
}

static void texts(void) {
    const char *words[2] = {"cat", "dog"};
    OpenDRStringsVectorT vector;
    initOpenDRStringsVector(&vector);
    loadOpenDRStringsVector(&vector, words, 1);
    loadOpenDRStringsVector(&vector, words, 2);
    assert(vector.size == 2 && vector.data[1] != words[1] && strcmp(vector.data[1], "dog") == 0);
    freeStringsVector(&vector);
    freeStringsVector(&vector);
}

int main(int argc, char **argv) {
    assert(argc == 2);
    json();
    pictures(argv[1]);
    detections();
    tensors();
    texts();
    return 0;
}
