// Reads the files that are named by OpenSceneGraph's own reader and prints of each its size, format, mip levels and a hash of all texels.

#include <cstdio>

#include <osg/Image>
#include <osgDB/ReadFile>

int main(int count, char **names) {
    for (int i = 1; i < count; ++i) {
        osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(names[i]);
        if (!image) {
            std::printf("refused\n");
            continue;
        }
        unsigned long long hash = 0xcbf29ce484222325ULL;
        for (unsigned int k = 0; k < image->getTotalSizeInBytesIncludingMipmaps(); ++k) {
            hash = (hash ^ image->data()[k]) * 0x100000001b3ULL;
        }
        std::printf("%d x %d x %d format %#x levels %u hash %016llx\n", image->s(), image->t(), image->r(),
                    image->getPixelFormat(), image->getNumMipmapLevels(), hash);
    }
}
