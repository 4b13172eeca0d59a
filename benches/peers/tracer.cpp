// A plain ray tracer in double precision: what a program without any emulation takes for the pictures of `lancer render`.
//
//   tracer SCENE.dsc MESH.off PICTURE.pfm            draws the scene, and says how many rays it sent
//   tracer --compare PICTURE.pfm OTHER.pfm           peak signal-to-noise ratio of two pictures, and pixels that differ by 1/255 or more
//
// The camera is the orthographic one, ambient light 0.1, 5 bounces, one shadow ray a light: the defaults of `lancer render`. Triangles are met by
// the test of Möller and Trumbore (1997), and found in a hierarchy of boxes that is divided by the surface-area heuristic in 16 bins.
// One thread, no vector instructions by hand.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double ambient = 0.1;
constexpr int bounces = 5;

struct Vec {
    double x = 0, y = 0, z = 0;
    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
Vec times(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec unit(Vec a) { return (1 / std::sqrt(dot(a, a))) * a; }

struct Box {
    Vec low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};

    void add(Vec p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    void add(const Box& b) { // which may be empty
        low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
        high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
    }
    double half_surface() const {
        Vec side = high - low;
        return side.x < 0 ? 0 : side.x * side.y + side.y * side.z + side.z * side.x;
    }
};

struct Material {
    Vec colour;
    double reflection, intensity, index;
    double transmission() const { return index == 0 ? 0 : std::max(0.0, 1 - reflection - intensity); }
};

struct Light {
    Vec position, colour;
};

struct Triangle {
    Vec corner, first, second; // a corner, and the edges to the other two
    int material;
};

struct Scene {
    int width = 0, height = 0;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<Triangle> triangles;
    Box box;
};

std::istringstream words(const char* path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(std::string("cannot read ") + path);
    std::string text, line;
    while (std::getline(file, line)) text += line.substr(0, line.find('#')) + '\n';
    return std::istringstream(text);
}

Scene read(const char* description, const char* mesh) {
    Scene scene;
    std::string magic;
    auto text = words(description);
    int materials = 0, lights = 0, triangles = 0;
    text >> magic >> scene.width >> scene.height >> materials >> lights;
    auto vector = [](std::istream& in) {
        Vec v;
        in >> v.x >> v.y >> v.z;
        return v;
    };
    for (int i = 0; i < materials; i++) {
        Material m{};
        m.colour = vector(text);
        text >> m.reflection >> m.intensity >> m.index;
        scene.materials.push_back(m);
    }
    for (int i = 0; i < lights; i++) {
        Vec position = vector(text);
        scene.lights.push_back({position, vector(text)});
    }
    text >> triangles;
    auto shape = words(mesh);
    int vertices = 0, faces = 0, edges = 0;
    shape >> magic >> vertices >> faces >> edges;
    std::vector<Vec> points;
    for (int i = 0; i < vertices; i++) points.push_back(vector(shape));
    if (!text || !shape || faces != triangles) throw std::runtime_error("a scene of triangles is wanted");
    for (int i = 0; i < faces; i++) {
        int corners = 0, material = 0;
        std::array<int, 3> v{};
        shape >> corners >> v[0] >> v[1] >> v[2];
        text >> material;
        if (!text || !shape || corners != 3) throw std::runtime_error("a scene of triangles is wanted");
        Vec a = points.at(v[0]), b = points.at(v[1]), c = points.at(v[2]);
        scene.triangles.push_back({a, b - a, c - a, material});
        for (Vec p : {a, b, c}) scene.box.add(p);
    }
    return scene;
}

struct Ray {
    Vec origin, direction, reciprocal;
    Ray(Vec o, Vec d) : origin(o), direction(d), reciprocal{1 / d.x, 1 / d.y, 1 / d.z} {}
};

struct Node {
    Box box;
    uint32_t first = 0; // of a leaf its first triangle, else the left child; the right one follows it
    uint32_t count = 0; // triangles of a leaf, 0 for an inner node
};

class Tree {
public:
    explicit Tree(std::vector<Triangle>& triangles) : triangles(triangles) {
        nodes.emplace_back();
        build(0, 0, triangles.size(), 0);
    }

    // Distance of the nearest hit, and its triangle; infinite without one.
    double nearest(const Ray& ray, uint32_t& hit) const {
        double end = infinite;
        walk(ray, end, [&](uint32_t number) {
            double t = meet(triangles[number], ray);
            if (t < end) {
                end = t;
                hit = number;
            }
            return false;
        });
        return end;
    }

    bool is_blocked(const Ray& ray, double end) const {
        bool blocked = false;
        walk(ray, end, [&](uint32_t number) { return blocked = meet(triangles[number], ray) < end; });
        return blocked;
    }

private:
    static double meet(const Triangle& triangle, const Ray& ray) {
        Vec p = cross(ray.direction, triangle.second);
        double determinant = dot(triangle.first, p);
        if (determinant == 0) return infinite;
        double inverse = 1 / determinant;
        Vec from = ray.origin - triangle.corner;
        double u = dot(from, p) * inverse;
        if (u < 0 || u > 1) return infinite;
        Vec q = cross(from, triangle.first);
        double v = dot(ray.direction, q) * inverse;
        if (v < 0 || u + v > 1) return infinite;
        double t = dot(triangle.second, q) * inverse;
        return t > 0 ? t : infinite;
    }

    // Distance at which the ray enters the box, infinite when it misses it before `end`: the slab test.
    static double enter(const Box& box, const Ray& ray, double end) {
        double near = 0, far = end;
        for (int axis = 0; axis < 3; axis++) {
            double a = (box.low[axis] - ray.origin[axis]) * ray.reciprocal[axis];
            double b = (box.high[axis] - ray.origin[axis]) * ray.reciprocal[axis];
            near = std::max(near, std::min(a, b));
            far = std::min(far, std::max(a, b));
        }
        return near <= far * (1 + 1e-12) ? near : infinite;
    }

    template <class Visit> void walk(const Ray& ray, double& end, Visit visit) const {
        struct Waiting {
            uint32_t node;
            double distance;
        };
        std::array<Waiting, 128> stack;
        int height = 0;
        if (enter(nodes[0].box, ray, end) == infinite) return;
        stack[height++] = {0, 0};
        while (height > 0) {
            Waiting next = stack[--height];
            if (next.distance > end) continue;
            const Node* node = &nodes[next.node];
            while (node->count == 0) {
                uint32_t near = node->first, far = node->first + 1;
                double a = enter(nodes[near].box, ray, end), b = enter(nodes[far].box, ray, end);
                if (b < a) {
                    std::swap(a, b);
                    std::swap(near, far);
                }
                if (a == infinite) break;
                if (b != infinite) stack[height++] = {far, b};
                node = &nodes[near];
            }
            for (uint32_t k = 0; k < node->count; k++) {
                if (visit(node->first + k)) return;
            }
        }
    }

    static Box box_of(const Triangle& t) {
        Box box;
        box.add(t.corner);
        box.add(t.corner + t.first);
        box.add(t.corner + t.second);
        return box;
    }

    void build(uint32_t number, size_t from, size_t to, int level) {
        constexpr int bins = 16;
        Box all, centres;
        auto centre = [](const Triangle& t) {
            Box box = box_of(t);
            return 0.5 * (box.low + box.high);
        };
        for (size_t i = from; i < to; i++) {
            all.add(box_of(triangles[i]));
            centres.add(centre(triangles[i]));
        }
        nodes[number].box = all;
        Vec side = centres.high - centres.low;
        int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
        size_t middle = from;
        if (to - from > 2 && side[axis] > 0 && level < 60) {
            auto bin = [&](const Triangle& t) {
                return std::min(bins - 1, int((centre(t)[axis] - centres.low[axis]) / side[axis] * bins));
            };
            std::array<Box, bins> boxes;
            std::array<size_t, bins> counts{};
            for (size_t i = from; i < to; i++) {
                boxes[bin(triangles[i])].add(box_of(triangles[i]));
                counts[bin(triangles[i])]++;
            }
            double best = to - from <= 8 ? double(to - from) * all.half_surface() : infinite;
            int cut = 0;
            for (int at = 1; at < bins; at++) {
                Box left, right;
                size_t n = 0;
                for (int k = 0; k < bins; k++) (k < at ? left : right).add(boxes[k]);
                for (int k = 0; k < at; k++) n += counts[k];
                if (n == 0 || n == to - from) continue;
                double cost = left.half_surface() * double(n) + right.half_surface() * double(to - from - n) + all.half_surface();
                if (cost < best) {
                    best = cost;
                    cut = at;
                }
            }
            if (cut > 0) {
                auto end = std::partition(triangles.begin() + from, triangles.begin() + to, [&](const Triangle& t) { return bin(t) < cut; });
                middle = end - triangles.begin();
            }
        }
        if (middle == from || middle == to) {
            nodes[number].first = from;
            nodes[number].count = to - from;
            return;
        }
        uint32_t left = nodes.size();
        nodes[number].first = left;
        nodes.resize(left + 2);
        build(left, from, middle, level + 1);
        build(left + 1, middle, to, level + 1);
    }

    std::vector<Triangle>& triangles;
    std::vector<Node> nodes;
};

struct Tracer {
    const Scene& scene;
    const Tree& tree;
    double offset; // distance by which secondary rays start off their surface
    uint64_t rays = 0;

    Vec colour(const Ray& ray, int level, bool inside) {
        rays++;
        uint32_t number = 0;
        double t = tree.nearest(ray, number);
        if (t == infinite) return {};
        const Triangle& triangle = scene.triangles[number];
        const Material& material = scene.materials[triangle.material];
        Vec point = ray.origin + t * ray.direction;
        Vec normal = unit(cross(triangle.first, triangle.second));
        if (dot(normal, ray.direction) > 0) normal = -1 * normal;
        Vec outside = point + offset * normal;
        Vec light{ambient, ambient, ambient};
        for (const Light& source : scene.lights) {
            Vec way = source.position - outside;
            double distance = std::sqrt(dot(way, way));
            Vec towards = (1 / distance) * way;
            double cosine = dot(normal, towards);
            if (cosine <= 0) continue;
            rays++;
            if (!tree.is_blocked({outside, towards}, distance)) light = light + material.intensity * cosine * source.colour;
        }
        Vec sum = times(material.colour, light);
        if (level == bounces) return sum;
        double cosine = -dot(ray.direction, normal);
        double reflection = material.reflection, transmission = material.transmission();
        if (transmission > 0) {
            double eta = inside ? material.index : 1 / material.index;
            double k = 1 - eta * eta * (1 - cosine * cosine);
            if (k >= 0) {
                Vec onwards = unit(eta * ray.direction + (eta * cosine - std::sqrt(k)) * normal);
                sum = sum + transmission * colour({point - offset * normal, onwards}, level + 1, !inside);
            } else {
                reflection += transmission;
            }
        }
        if (reflection > 0) {
            Vec back = unit(ray.direction + 2 * cosine * normal);
            sum = sum + reflection * colour({outside, back}, level + 1, inside);
        }
        return sum;
    }
};

struct Picture {
    int width = 0, height = 0;
    std::vector<float> values; // rows from the bottom up, as PFM has them
};

Picture read_picture(const char* path) {
    std::ifstream file(path, std::ios::binary);
    std::string magic;
    double scale = 0;
    Picture picture;
    file >> magic >> picture.width >> picture.height >> scale;
    file.get();
    if (!file || magic != "PF" || scale > 0) throw std::runtime_error(std::string(path) + " is no little-endian PFM");
    picture.values.resize(size_t(3) * picture.width * picture.height);
    file.read(reinterpret_cast<char*>(picture.values.data()), std::streamsize(picture.values.size() * sizeof(float)));
    if (!file) throw std::runtime_error(std::string(path) + " is cut short");
    return picture;
}

int compare(const char* one, const char* other) {
    Picture a = read_picture(one), b = read_picture(other);
    if (a.width != b.width || a.height != b.height) throw std::runtime_error("the pictures have different sizes");
    double squares = 0;
    int off = 0;
    for (size_t i = 0; i < a.values.size(); i += 3) {
        double largest = 0;
        for (size_t k = i; k < i + 3; k++) {
            double difference = double(a.values[k]) - double(b.values[k]);
            squares += difference * difference;
            largest = std::max(largest, std::fabs(difference));
        }
        off += largest >= 1.0 / 255;
    }
    std::printf("%.1f dB, %d off\n", -10 * std::log10(squares / double(a.values.size())), off);
    return 0;
}

int draw(const char* description, const char* mesh, const char* path) {
    Scene scene = read(description, mesh);
    Tree tree(scene.triangles);
    Vec side = scene.box.high - scene.box.low, middle = 0.5 * (scene.box.low + scene.box.high);
    double extent = std::max({side.x, side.y, side.z});
    double pitch = std::max(side.x / scene.width, side.y / scene.height);
    Tracer tracer{scene, tree, 1e-10 * extent};
    Picture picture{scene.width, scene.height, {}};
    for (int row = scene.height - 1; row >= 0; row--) {
        for (int column = 0; column < scene.width; column++) {
            double x = middle.x + (column + 0.5 - scene.width / 2.0) * pitch;
            double y = middle.y + (scene.height / 2.0 - row - 0.5) * pitch;
            Vec c = tracer.colour({{x, y, scene.box.high.z + extent / 16}, {0, 0, -1}}, 0, false);
            for (double value : {c.x, c.y, c.z}) picture.values.push_back(float(std::clamp(value, 0.0, 1.0)));
        }
    }
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << scene.width << ' ' << scene.height << "\n-1.0\n";
    file.write(reinterpret_cast<const char*>(picture.values.data()), std::streamsize(picture.values.size() * sizeof(float)));
    file.flush();
    if (!file) throw std::runtime_error(std::string("cannot write ") + path);
    std::printf("%llu rays\n", static_cast<unsigned long long>(tracer.rays));
    return 0;
}

} // namespace

int main(int count, char** arguments) {
    try {
        if (count == 4 && std::string(arguments[1]) == "--compare") return compare(arguments[2], arguments[3]);
        if (count == 4) return draw(arguments[1], arguments[2], arguments[3]);
        std::cerr << "usage: tracer SCENE.dsc MESH.off PICTURE.pfm\n       tracer --compare PICTURE.pfm OTHER.pfm\n";
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}
