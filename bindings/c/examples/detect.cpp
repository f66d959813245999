// Detects objects in images, folders, videos or a camera: detect_cpp INPUT [MODEL]
#include <opendr.h>

#include <iostream>
#include <memory>
#include <stdexcept>

struct Free {
    void operator()(opendr_learner *learner) const { opendr_learner_free(&learner); }
    void operator()(opendr_source *source) const { opendr_source_free(&source); }
    void operator()(opendr_image *image) const { opendr_image_free(&image); }
    void operator()(opendr_bounding_box_list *boxes) const { opendr_bounding_box_list_free(&boxes); }
};

template <class T, class Create> std::unique_ptr<T, Free> create(Create function) {
    T *handle = nullptr;
    if (function(&handle) != OPENDR_OK) throw std::runtime_error(opendr_last_error());
    return std::unique_ptr<T, Free>(handle);
}

int main(int argc, char **argv) try {
    if (argc < 2) throw std::invalid_argument("usage: detect_cpp INPUT [MODEL]");
    const char *model = argc > 2 ? argv[2] : nullptr;
    auto detector = create<opendr_learner>([&](auto out) { return opendr_load_nanodet(model, nullptr, nullptr, out); });
    auto source = create<opendr_source>([&](auto out) { return opendr_source_open(argv[1], out); });
    while (auto image = create<opendr_image>([&](auto out) { return opendr_source_next(source.get(), out); })) {
        auto boxes = create<opendr_bounding_box_list>(
            [&](auto out) { return opendr_infer_nanodet(detector.get(), image.get(), out); });
        std::cout << opendr_source_path(source.get()) << ": " << opendr_bounding_box_list_count(boxes.get()) << "\n";
    }
} catch (const std::exception &error) {
    std::cerr << error.what() << "\n";
    return 1;
}
