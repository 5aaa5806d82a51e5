#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "graph/compile_steps.h"

namespace heliodon::graph {
namespace {

/// `from` runs before `to`. With `data`, `to` reads what `from` writes.
struct Dependency {
    std::uint32_t from = 0, to = 0;
    bool data = false;
};

struct PassUse {
    std::uint32_t pass;
    const ResourceUse* use;
};

std::vector<std::vector<PassUse>> uses_by_resource(const Graph& graph) {
    std::vector<std::vector<PassUse>> uses(graph.resources().size());
    for (std::uint32_t pass = 0; pass < graph.passes().size(); ++pass)
        for (const ResourceUse& use : graph.passes()[pass].uses) uses[use.resource].push_back({pass, &use});
    return uses;
}

/// A read of a transient part that nothing declared before writes: it waits for the later writers.
bool reads_later_writes(const std::vector<PassUse>& uses, const PassUse& reader, const Resource& resource) {
    if (!reader.use->reads || resource.lifetime != Lifetime::transient) return false;
    return std::ranges::none_of(uses, [&](const PassUse& other) {
        return other.pass < reader.pass && other.use->writes && overlap(*other.use, *reader.use);
    });
}

Result<void> add_dependencies(std::vector<Dependency>& dependencies, const Graph& graph, const Resource& resource,
                              const std::vector<PassUse>& uses) {
    for (const PassUse& user : uses) {
        const bool late = reads_later_writes(uses, user, resource);
        bool written = false;
        for (const PassUse& other : uses) {
            if (other.pass == user.pass || !other.use->writes || !overlap(*other.use, *user.use)) continue;
            written = true;
            if (late || (user.use->reads && other.pass < user.pass))
                dependencies.push_back({other.pass, user.pass, true});
            else if (other.pass < user.pass)
                dependencies.push_back({other.pass, user.pass, false});  // write after write
            else if (user.use->reads && !late)
                dependencies.push_back({user.pass, other.pass, false});  // write after read
        }
        if (late && !written)
            return fail(fmt::format("pass '{}'", graph.passes()[user.pass].name),
                        fmt::format("reads '{}', which no pass writes", resource.name()));
    }
    return {};
}

/// One resource may be used twice by a pass only where both uses agree.
Result<void> check_uses(const Graph& graph) {
    for (const PassDeclaration& pass : graph.passes())
        for (std::size_t i = 0; i < pass.uses.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const ResourceUse &a = pass.uses[i], &b = pass.uses[j];
                if (!overlap(a, b)) continue;
                const Resource& resource = graph.resources()[a.resource];
                const bool same = a.usage == b.usage;
                const bool both_read = !a.writes && !b.writes;
                const bool same_layout = !resource.is_image || access_of(a.usage, pass.kind, true, false).layout ==
                                                                   access_of(b.usage, pass.kind, true, false).layout;
                if (!same && !(both_read && same_layout))
                    return fail(fmt::format("pass '{}'", pass.name),
                                fmt::format("uses '{}' both as {} and as {}", resource.name(), usage_name(b.usage),
                                            usage_name(a.usage)));
            }
    return {};
}

/// Marks what the outputs need, from the passes that must run back to what they read.
std::vector<bool> find_live(const Graph& graph, const std::vector<Dependency>& dependencies,
                            const std::vector<std::vector<PassUse>>& uses) {
    const auto& passes = graph.passes();
    const auto& resources = graph.resources();
    std::vector<bool> live(passes.size(), false);
    std::vector<std::uint32_t> open;
    const auto mark = [&](std::uint32_t pass) {
        if (live[pass]) return;
        live[pass] = true;
        open.push_back(pass);
    };
    const auto mark_writers = [&](std::uint32_t resource) {
        for (const PassUse& user : uses[resource])
            if (user.use->writes) mark(user.pass);
    };
    for (std::uint32_t pass = 0; pass < passes.size(); ++pass)
        if (passes[pass].side_effect) mark(pass);
    for (std::uint32_t index = 0; index < resources.size(); ++index)
        if (resources[index].exported || resources[index].lifetime == Lifetime::imported) mark_writers(index);
    while (!open.empty()) {
        const std::uint32_t pass = open.back();
        open.pop_back();
        for (const Dependency& dependency : dependencies)
            if (dependency.data && dependency.to == pass) mark(dependency.from);
        // What persists is read again next frame, so its writers count wherever they stand.
        for (const ResourceUse& use : passes[pass].uses) {
            const Resource& resource = resources[use.resource];
            if (!use.reads || resource.lifetime != Lifetime::persistent) continue;
            mark_writers(resource.history_of != ~0u ? resource.history_of : use.resource);
        }
    }
    return live;
}

/// Names one cycle among the passes that could not be ordered.
std::string name_cycle(const Graph& graph, const std::vector<Dependency>& dependencies,
                       const std::vector<bool>& waiting) {
    std::uint32_t pass = 0;
    while (!waiting[pass]) ++pass;
    std::vector<std::uint32_t> path;
    // Every waiting pass waits for another one: walking back must come round.
    while (std::ranges::find(path, pass) == path.end()) {
        path.push_back(pass);
        pass = std::ranges::find_if(dependencies, [&](const Dependency& d) {
                   return d.to == pass && waiting[d.from];
               })->from;
    }
    std::string text = fmt::format("'{}'", graph.passes()[pass].name);
    for (auto step = path.rbegin(); step != path.rend(); ++step) {
        text += fmt::format(" → '{}'", graph.passes()[*step].name);
        if (*step == pass) break;
    }
    return text;
}

}  // namespace

bool overlap(const ResourceUse& a, const ResourceUse& b) {
    return a.resource == b.resource && a.base_mip < b.base_mip + b.mips && b.base_mip < a.base_mip + a.mips &&
           a.base_layer < b.base_layer + b.layers && b.base_layer < a.base_layer + a.layers;
}

Result<PassOrder> order_passes(const Graph& graph) {
    if (!graph.errors().empty()) return tl::unexpected(graph.errors().front());
    if (auto checked = check_uses(graph); !checked) return tl::unexpected(checked.error());

    const auto uses = uses_by_resource(graph);
    std::vector<Dependency> dependencies;
    for (std::uint32_t index = 0; index < uses.size(); ++index)
        if (auto added = add_dependencies(dependencies, graph, graph.resources()[index], uses[index]); !added)
            return tl::unexpected(added.error());
    for (std::uint32_t pass = 0; pass < graph.passes().size(); ++pass)
        for (const std::uint32_t earlier : graph.passes()[pass].after) dependencies.push_back({earlier, pass, false});

    const std::vector<bool> live = find_live(graph, dependencies, uses);
    std::erase_if(dependencies, [&](const Dependency& d) { return !live[d.from] || !live[d.to]; });

    // Kahn's algorithm; of the passes that are ready, the one declared first.
    PassOrder result;
    std::vector<std::uint32_t> waits_for(graph.passes().size(), 0);
    for (const Dependency& dependency : dependencies) ++waits_for[dependency.to];
    std::set<std::uint32_t> ready;
    std::vector<bool> waiting = live;
    for (std::uint32_t pass = 0; pass < graph.passes().size(); ++pass) {
        if (!live[pass])
            result.culled.push_back(pass);
        else if (waits_for[pass] == 0)
            ready.insert(pass);
    }
    while (!ready.empty()) {
        const std::uint32_t pass = *ready.begin();
        ready.erase(ready.begin());
        waiting[pass] = false;
        result.order.push_back(pass);
        for (const Dependency& dependency : dependencies)
            if (dependency.from == pass && --waits_for[dependency.to] == 0) ready.insert(dependency.to);
    }
    if (result.order.size() + result.culled.size() != graph.passes().size())
        return fail("frame graph", "the passes wait for each other: " + name_cycle(graph, dependencies, waiting));
    return result;
}

}  // namespace heliodon::graph
