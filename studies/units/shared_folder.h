#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace capstan::units {

/// The folder in which workers on any machines agree on who does what: small files by their names, and a
/// clock. The workers know nothing else of each other, so that the simulation of their tests needs nothing
/// else. Every member may throw std::runtime_error where the disk fails; what it should have done then has
/// happened or not.
class SharedFolder {
  public:
    /// While it lives, a file's time is renewed every few seconds.
    class Heart {
      public:
        virtual ~Heart() = default;
    };

    virtual ~SharedFolder() = default;

    /// "node7-4711": this process, in the names of files and in messages.
    virtual std::string worker() const = 0;

    /// The disk's time [s]: the clocks of the machines may differ.
    virtual double now_s() = 0;
    virtual void pause(double seconds) = 0;

    /// False if the file is there already: of several workers only one makes it.
    virtual bool create(const std::string& name, const std::string& text) = 0;
    /// All of the new text, or none of it.
    virtual void replace(const std::string& name, const std::string& text) = 0;
    /// Nothing where the file does not exist.
    virtual std::optional<std::string> read(const std::string& name) = 0;
    virtual std::optional<double> modified_s(const std::string& name) = 0;
    virtual std::vector<std::string> names() = 0;

    // False: it is not there, or for link() there is one already.
    virtual bool rename(const std::string& from, const std::string& to) = 0;
    virtual bool link(const std::string& from, const std::string& to) = 0;
    virtual bool remove(const std::string& name) noexcept = 0;

    virtual std::unique_ptr<Heart> beat(const std::string& name) = 0;
};

/// A folder on a disk that all machines see, NFS included.
class DiskFolder final : public SharedFolder {
  public:
    explicit DiskFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::string worker() const override;
    /// Of a folder that may not be written, this machine's.
    double now_s() override;
    void pause(double seconds) override;
    bool create(const std::string& name, const std::string& text) override;
    void replace(const std::string& name, const std::string& text) override;
    std::optional<std::string> read(const std::string& name) override;
    std::optional<double> modified_s(const std::string& name) override;
    std::vector<std::string> names() override;
    bool rename(const std::string& from, const std::string& to) override;
    bool link(const std::string& from, const std::string& to) override;
    bool remove(const std::string& name) noexcept override;
    std::unique_ptr<Heart> beat(const std::string& name) override;

  private:
    std::filesystem::path folder_;
};

}  // namespace capstan::units
